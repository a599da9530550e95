#pragma once

#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace Rabit
{

// Lets the transport encode a message straight into its own buffer. The message must outlive it unchanged.
class MessageEncoder final : public SampleEncoder
{
public:
    MessageEncoder(const MessageType &type, const RabitMessage &message)
        : _type(type), _message(message), _size(type.SerializedSize(message))
    {
    }

    std::size_t EncodedSize() const override { return _size; }

    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        return _type.Serialize(_message, buffer) == buffer.size();
    }

private:
    const MessageType &_type;
    const RabitMessage &_message;
    std::size_t _size;
};

// Hands bytes to the transport that are encoded already.
class BytesEncoder final : public SampleEncoder
{
public:
    explicit BytesEncoder(std::span<const std::uint8_t> bytes) : _bytes(bytes) {}

    std::size_t EncodedSize() const override { return _bytes.size(); }

    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        if (buffer.size() != _bytes.size())
        {
            return false;
        }
        std::copy(_bytes.begin(), _bytes.end(), buffer.begin());
        return true;
    }

private:
    const std::span<const std::uint8_t> _bytes;
};

}  // namespace Rabit
