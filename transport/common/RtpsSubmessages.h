// The parts of an RTPS message (OMG DDSI-RTPS 2.3, 9.4) that code needs to inspect a vendor's datagrams.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace Rabit
{

constexpr std::size_t RtpsHeaderSize = 20;
constexpr std::size_t SubmessageHeaderSize = 4;
// The entity that writes the announcements of participants (9.3.1.3).
constexpr std::array<std::uint8_t, 4> ParticipantWriterId{0x00, 0x01, 0x00, 0xc2};

// Byte: const std::uint8_t, or std::uint8_t to change it.
template <typename Byte>
struct RtpsSubmessage
{
    std::uint8_t Kind = 0;
    std::uint8_t Flags = 0;
    bool LittleEndian = false;
    std::span<Byte> Whole;  // with its header, up to the end of the message at most
    std::span<Byte> Body() const { return Whole.subspan(SubmessageHeaderSize); }
};

// Calls visit(submessage) for each submessage behind a header of `header` bytes. The message may be cut off
// and its content may be invalid: nothing outside of it is touched.
template <typename Byte, typename Visit>
void VisitSubmessages(std::span<Byte> message, std::size_t header, const Visit &visit)
{
    // 9.4.5.1.3: for all other kinds, a length of 0 means up to the end of the message.
    constexpr std::uint8_t pad = 0x01;
    constexpr std::uint8_t timestamp = 0x09;
    auto rest = message.subspan(std::min(header, message.size()));
    while (rest.size() >= SubmessageHeaderSize)
    {
        RtpsSubmessage<Byte> found{
            .Kind = rest[0], .Flags = rest[1], .LittleEndian = (rest[1] & 0x01) != 0, .Whole = {}};
        const std::size_t first = rest[2];
        const std::size_t second = rest[3];
        const std::size_t length = found.LittleEndian ? second << 8 | first : first << 8 | second;
        const bool toTheEnd = length == 0 && found.Kind != pad && found.Kind != timestamp;
        found.Whole = toTheEnd ? rest : rest.first(std::min(SubmessageHeaderSize + length, rest.size()));
        visit(found);
        rest = rest.subspan(found.Whole.size());
    }
}
template <typename Byte, typename Visit>
void VisitSubmessages(std::span<Byte> message, const Visit &visit)
{
    VisitSubmessages(message, RtpsHeaderSize, visit);
}

}  // namespace Rabit
