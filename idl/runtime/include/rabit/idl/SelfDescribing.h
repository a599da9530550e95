#pragma once

namespace Rabit
{
class MessageType;
}

namespace Rabit::Idl
{

// Base of a message class that serves several IDL types. Its C++ class does not tell the type, so
// MessageTypeRegistry::Of asks the message itself.
class SelfDescribing
{
public:
    virtual ~SelfDescribing() = default;
    // The type of this message; it lives at least as long as the message.
    virtual const MessageType &IdlType() const = 0;
};

}  // namespace Rabit::Idl
