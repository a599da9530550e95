#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/MessageNotRegisteredException.h>
#include <rabit/QueueTypeException.h>

#include <boost/core/demangle.hpp>

#include <utility>

namespace Rabit
{

GlobalPublishSubscribeException::GlobalPublishSubscribeException()
    : GlobalPublishSubscribeException("the message is not registered under a name")
{
}

GlobalPublishSubscribeException::GlobalPublishSubscribeException(std::string text) : _text(std::move(text)) {}

const char *GlobalPublishSubscribeException::what() const noexcept
{
    return _text.c_str();
}

MessageNotRegisteredException::MessageNotRegisteredException()
    : MessageNotRegisteredException("no message or queue is registered under that name")
{
}

MessageNotRegisteredException::MessageNotRegisteredException(std::string text) : _text(std::move(text)) {}

const char *MessageNotRegisteredException::what() const noexcept
{
    return _text.c_str();
}

QueueTypeException::QueueTypeException(const std::string &queueName, std::type_index held,
                                       std::type_index wanted)
    : _text("queue \"" + queueName + "\" is of type " + boost::core::demangle(held.name()) + ", not " +
            boost::core::demangle(wanted.name()))
{
}

const char *QueueTypeException::what() const noexcept
{
    return _text.c_str();
}

}  // namespace Rabit
