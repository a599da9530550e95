// The parts of an RTPS message (OMG DDSI-RTPS 2.3, 8.3 and 9.4), read without trusting any of it.
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
// Its four bytes as one number, the first the highest: 0x000100c2 writes the announcements of participants.
using EntityId = std::uint32_t;
// Of IPv4, as it is said: 10.0.0.1 begins with 10.
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
    // Of DDS Security, 7.3.6.2: encrypted or signed ones, and what is put around them.
    FirstSecure = 0x30,
    LastSecure = 0x35,
    // Fast DDS's own, at the end of each message that it sends.
    Statistics = 0x80
};

struct Submessage
{
    SubmessageKind Kind = SubmessageKind::Pad;
    std::uint8_t Flags = 0;
    bool LittleEndian = false;
    // With its header.
    std::span<std::uint8_t> Whole;
    std::span<std::uint8_t> Body() const { return Whole.subspan(SubmessageHeaderSize); }
};

// Whether this is a message of RTPS 2 whose sender has a name.
bool HasRtpsHeader(std::span<const std::uint8_t> datagram);

// True if this is the datagram by which Cyclone DDS wakes its own receiving threads when it ends: one zero
// byte. It also goes to the multicast address of discovery, and so to all participants of the domain.
bool IsWakeUpOfCycloneDds(std::span<const std::uint8_t> datagram);

// The name of the participant that sent the message. It must have a header.
GuidPrefix SenderOf(std::span<const std::uint8_t> datagram);

// Puts the participant that an INFO_SRC names into a header, as if it had sent what follows in a message of
// its own. False if it names none.
bool PutSource(const Submessage &submessage, std::span<std::uint8_t> header);

// Takes the first submessage off `rest`, which must not be empty. Nothing if there is no whole one, or if its
// length would let two parsers disagree about where the next one begins.
std::optional<Submessage> TakeSubmessage(std::span<std::uint8_t> &rest);

// Of a submessage with statistics.
constexpr std::size_t StatisticsSize = SubmessageHeaderSize + 56;

// How long a message of our own is without the statistics that Fast DDS puts at the end of each. They are of
// no use to us, and 60 bytes of a radio's time.
std::size_t SizeWithoutStatistics(std::span<const std::uint8_t> datagram);

// Whether Fast DDS's sockets would take the end of a message for their statistics, and write into it: they go
// by one byte.
bool EndsLikeStatistics(std::span<const std::uint8_t> datagram);

// Puts the header of a little-endian submessage at the end of a message; `length` is that of its body.
void AppendSubmessageHeader(std::vector<std::uint8_t> &message, SubmessageKind kind, std::size_t length,
                            std::uint8_t flags = 0);

// Turns a submessage into padding, which no parser looks into.
void Blank(const Submessage &submessage);

}  // namespace Rabit::Rtps
