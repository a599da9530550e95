#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace Rabit
{

// The end of each datagram of a key exchange that is not protected as a whole: a submessage of our own, which
// receivers skip. It tells each side how long answers take, also where datagrams are lost and repeated. An
// answer itself does not tell that, since it may answer any of the repetitions.
struct KeyExchangeStamp
{
    static constexpr std::size_t Size = 16;  // in a datagram

    std::uint32_t SentAt = 0;  // milliseconds, by the sender's clock
    // SentAt of the newest datagram that came from the addressee, plus the time since it came; 0: none came.
    std::uint32_t Echo = 0;

    void AppendTo(std::vector<std::uint8_t> &datagram) const;
    // Empty if the datagram does not end in one.
    static std::optional<KeyExchangeStamp> Of(std::span<const std::uint8_t> datagram);
};

}  // namespace Rabit
