#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "guard/RtpsMessage.h"

namespace Rabit::FastDds
{

// A reader's first request to a writer, repeated until the writer answers: the reader has no sample yet, and
// does not know of one that it lacks.
struct FirstRequest
{
    Rtps::GuidPrefix Peer{};
    Rtps::EntityId Reader = 0;
    Rtps::EntityId Writer = 0;
    auto operator<=>(const FirstRequest &) const = default;
};

// A datagram that states only which samples a writer has.
struct LoneHeartbeat
{
    Rtps::GuidPrefix Peer{};  // zero: for all
    Rtps::EntityId Writer = 0;
    std::int64_t First = 0;
    std::int64_t Last = 0;
};

// Properties of a datagram of our own that decide when it goes and how it is counted.
struct OutgoingMessage
{
    // It contains data of other than builtin endpoints: samples, or their repair.
    bool HasSamples = false;
    // It has one or more whole samples for one participant and nothing else. Sent to that participant's
    // address alone, it needs no INFO_DST (RTPS 2.3, 8.3.4.1: without it, the receiver is the addressee).
    bool IsOfSamplesToOne = false;
    // Set if it only announces our participant: a hash of the announcement. A goodbye is no announcement.
    std::optional<std::uint64_t> Announcement;
    // Each set if it contains nothing else.
    std::optional<FirstRequest> Request;
    std::optional<LoneHeartbeat> Heartbeat;
};

// `datagram` comes from the vendor's writers and is trusted to be sound.
OutgoingMessage ReadOutgoing(std::span<const std::uint8_t> datagram);

// Copies the datagram without its INFO_DST submessage, which takes 16 bytes.
void WriteWithoutDestination(std::span<const std::uint8_t> datagram, std::vector<std::uint8_t> &to);

// Copies a participant's announcement without its list of properties, which only the vendor's discovery
// servers use (124 bytes of 420), and without inline QoS (32 bytes when the vendor answers another
// participant).
void WriteWithoutProperties(std::span<const std::uint8_t> announcement, std::vector<std::uint8_t> &to);

// The UDP ports at which a participant takes discovery data, as its announcement says.
std::vector<std::uint32_t> DiscoveryPortsOf(std::span<const std::uint8_t> announcement);

// A peer's acknowledgement to a writer of ours.
struct Acknowledgement
{
    Rtps::GuidPrefix Peer{};
    Rtps::EntityId Reader = 0;
    Rtps::EntityId Writer = 0;
    std::int64_t Base = 0;  // the reader has all samples before this one
    bool Asks = false;      // requests repair, or all samples
};

// The acknowledgements in a received datagram, which must be sound and without data for others.
std::vector<Acknowledgement> ReadAcknowledgements(std::span<const std::uint8_t> datagram);

}  // namespace Rabit::FastDds
