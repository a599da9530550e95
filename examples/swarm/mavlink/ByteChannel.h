#pragma once

#include "BadInput.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace Swarm
{

// A channel that cannot be opened, or whose description is wrong. what() is one line for a person.
class ChannelError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// Bytes to and from an autopilot. Nothing here waits. Used by one thread.
class ByteChannel
{
public:
    virtual ~ByteChannel() = default;

    // Copies what has come, up to the size of the buffer; 0 if there is nothing, or nothing any more.
    virtual std::size_t Receive(std::span<std::uint8_t> buffer) = 0;
    // Sends all or nothing. False: it could not be sent now, for instance because nobody has been heard yet.
    virtual bool Send(std::span<const std::uint8_t> bytes) = 0;
};

// `udp:PORT` listens on that port of all interfaces and answers whoever sent last; `serial:DEVICE:BAUD` opens
// a serial port with 8 data bits, no parity, 1 stop bit. Throws ChannelError.
std::unique_ptr<ByteChannel> OpenByteChannel(const std::string &description);

}  // namespace Swarm
