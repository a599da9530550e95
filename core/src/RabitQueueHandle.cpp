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

std::string RefusalReasonOf(QueueAddResult result, const std::string &queue)
{
    switch (result)
    {
        case QueueAddResult::Full:
            return "the queue `" + queue + "` is full";
        case QueueAddResult::UnknownQueue:
            return "there is no queue `" + queue + "`";
        case QueueAddResult::WrongType:
            return "the queue `" + queue + "` takes messages of another type";
        case QueueAddResult::Ok:
            break;
    }
    return "";
}

std::ostream &operator<<(std::ostream &stream, QueueAddResult result)
{
    return stream << ToString(result);
}

}  // namespace Rabit
