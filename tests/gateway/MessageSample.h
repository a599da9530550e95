#pragma once

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/transport/Transport.h>

namespace Rabit
{

// Encodes a message for a transport. The message must outlive it.
class MessageSample final : public SampleEncoder
{
public:
    explicit MessageSample(const RabitMessage &message)
        : _type(*MessageTypeRegistry::Of(message)), _message(message)
    {
    }
    std::size_t EncodedSize() const override { return _type.SerializedSize(_message); }
    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        return _type.Serialize(_message, buffer) == buffer.size();
    }

private:
    const MessageType &_type;
    const RabitMessage &_message;
};

}  // namespace Rabit
