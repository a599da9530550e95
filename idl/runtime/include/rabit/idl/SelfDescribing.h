#pragma once

namespace Rabit
{
class MessageType;
}

namespace Rabit::Idl
{

// What a message class is that serves several IDL types, so that its C++ class does not tell the type:
// MessageTypeRegistry::Of asks the message itself.
class SelfDescribing
{
public:
    virtual ~SelfDescribing() = default;
    // The type of this message; it lives at least as long as the message.
    virtual const MessageType &IdlType() const = 0;
};

}  // namespace Rabit::Idl
