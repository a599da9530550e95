// Checks and changes the parts of a whole RTPS message (OMG DDSI-RTPS 2.3, 8.3 and 9.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/RtpsReader.h"

namespace Rabit::Rtps
{

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

// Size of a message without the statistics that Fast DDS puts at the end of each of its own: 60 unused bytes
// that would take a radio's time. The message may still end like statistics.
std::size_t SizeWithoutStatistics(std::span<const std::uint8_t> datagram);

// True if Fast DDS's sockets would mistake the end of a message for their statistics, and write into it: they
// check a single byte.
bool EndsLikeStatistics(std::span<const std::uint8_t> datagram);

// Turns a submessage into padding, which no parser looks into.
void Blank(const Submessage &submessage);
// Turns a DATA of a builtin writer of endpoints into a GAP that declares its number absent to the builtin
// reader, and padding. It must have room for both (36 bytes).
void MakeGap(const Submessage &data);

}  // namespace Rabit::Rtps
