#pragma once

#include "BadInput.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace Swarm
{

// Thrown if a channel cannot be opened, or its description is wrong. what() is one line for a person.
class ChannelError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// Bytes to and from an autopilot. No method blocks. Used by one thread.
class ByteChannel
{
public:
    using Time = std::chrono::nanoseconds;  // of the workspace's monotonic clock

    virtual ~ByteChannel() = default;

    // Copies received bytes, up to the size of the buffer. Returns 0 if there are none, or the channel has
    // ended.
    virtual std::size_t Receive(std::span<std::uint8_t> buffer, Time now) = 0;
    // Sends all bytes or none. False if it cannot send now, for instance because no peer has been heard
    // yet.
    virtual bool Send(std::span<const std::uint8_t> bytes) = 0;
};

// `udp:PORT` listens on that port of the loopback address, `udp:ADDRESS:PORT` on that of an address of this
// machine, both as a UdpChannel. `serial:DEVICE:BAUD` opens a serial port with 8 data bits, no parity, 1 stop
// bit. Throws ChannelError.
std::unique_ptr<ByteChannel> OpenByteChannel(const std::string &description);

}  // namespace Swarm
