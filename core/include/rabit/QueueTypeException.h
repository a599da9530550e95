#pragma once

#include <any>
#include <string>
#include <typeindex>

namespace Rabit
{

// Thrown when a queue is used as one of another type: it was requested as another type, or an element was
// added that neither is of its element type nor converts to it.
class QueueTypeException : public std::bad_any_cast
{
public:
    QueueTypeException(const std::string &queueName, std::type_index held, std::type_index wanted);
    const char *what() const noexcept override;

private:
    std::string _text;
};

}  // namespace Rabit
