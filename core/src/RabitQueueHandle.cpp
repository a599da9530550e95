#include <rabit/RabitQueueHandle.h>

#include <ostream>

namespace Rabit
{

const char *ToString(QueueAddResult result)
{
    switch (result)
    {
        case QueueAddResult::Ok:
            return "ok";
        case QueueAddResult::Full:
            return "full";
        case QueueAddResult::UnknownQueue:
            return "unknown queue";
        case QueueAddResult::WrongType:
            return "wrong type";
    }
    return "unknown";
}

std::ostream &operator<<(std::ostream &stream, QueueAddResult result)
{
    return stream << ToString(result);
}

}  // namespace Rabit
