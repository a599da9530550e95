// The parts of an RTPS message (OMG DDSI-RTPS 2.3, 8.3 and 9.4), parsed as untrusted input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/RtpsSubmessages.h"

namespace Rabit::Rtps
{

using GuidPrefix = std::array<std::uint8_t, 12>;
// Its four bytes as one big-endian number: 0x000100c2 writes the announcements of participants.
using EntityId = std::uint32_t;
// IPv4 address in reading order: 10.0.0.1 begins with 10.
using HostAddress = std::array<std::uint8_t, 4>;
constexpr HostAddress UnknownHost{};

// RTPS 2.3, 9.4.5.1.1; those from 0x80 on are the vendors' own.
enum class SubmessageKind : std::uint8_t
{
    Pad = 0x01,
    AckNack = 0x06,
    Heartbeat = 0x07,
    Gap = 0x08,
    InfoTimestamp = 0x09,
    InfoSource = 0x0c,
    InfoDestination = 0x0e,
    NackFrag = 0x12,
    HeartbeatFrag = 0x13,
    Data = 0x15,
    DataFrag = 0x16,
    // DDS Security, 7.3.6.2: encrypted or signed submessages, and their prefixes and postfixes.
    FirstSecure = 0x30,
    SecureBody = 0x30,
    LastSecure = 0x35,
    // Fast DDS's own, at the end of each message that it sends.
    Statistics = 0x80
};

struct Submessage
{
    SubmessageKind Kind = SubmessageKind::Pad;
    std::uint8_t Flags = 0;
    bool LittleEndian = false;
    // Includes the header.
    std::span<std::uint8_t> Whole;
    std::span<std::uint8_t> Body() const { return Whole.subspan(SubmessageHeaderSize); }
};

// True if this is an RTPS 2 message with a sender.
bool HasRtpsHeader(std::span<const std::uint8_t> datagram);

// True if this is the datagram by which Cyclone DDS wakes its own receiving threads when it ends: one zero
// byte. It also goes to the multicast address of discovery, and so to all participants of the domain.
bool IsWakeUpOfCycloneDds(std::span<const std::uint8_t> datagram);

// The participant that sent the message, which must have a header.
GuidPrefix SenderOf(std::span<const std::uint8_t> datagram);

// Puts the participant that an INFO_SRC names into `header`, as if it had sent the following submessages in a
// message of its own. Returns false if the submessage is unsound.
bool PutSource(const Submessage &submessage, std::span<std::uint8_t> header);

// Takes the first submessage off `rest`, which must not be empty. Empty if there is no whole one, or if its
// length would let two parsers disagree about where the next one begins.
std::optional<Submessage> TakeSubmessage(std::span<std::uint8_t> &rest);

// Size of a submessage with statistics.
constexpr std::size_t StatisticsSize = SubmessageHeaderSize + 56;

// Size of a message of our own without the statistics that Fast DDS puts at the end of each: 60 unused bytes
// that would take a radio's time.
std::size_t SizeWithoutStatistics(std::span<const std::uint8_t> datagram);

// True if Fast DDS's sockets would mistake the end of a message for their statistics, and write into it: they
// check a single byte.
bool EndsLikeStatistics(std::span<const std::uint8_t> datagram);

// Appends the header of a little-endian submessage to a message; `length` is that of its body.
void AppendSubmessageHeader(std::vector<std::uint8_t> &message, SubmessageKind kind, std::size_t length,
                            std::uint8_t flags = 0);

// Turns a submessage into padding, which no parser looks into.
void Blank(const Submessage &submessage);

}  // namespace Rabit::Rtps
