#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "guard/RtpsMessage.h"

namespace Rabit::FastDds
{

// A reader that asks a writer for the first time, and again until the writer answers: it has nothing yet, and
// knows of nothing that it lacks.
struct FirstRequest
{
    Rtps::GuidPrefix Peer{};
    Rtps::EntityId Reader = 0;
    Rtps::EntityId Writer = 0;
    auto operator<=>(const FirstRequest &) const = default;
};

// All that a datagram says is which samples a writer has.
struct LoneHeartbeat
{
    Rtps::GuidPrefix Peer{};  // zero: all
    Rtps::EntityId Writer = 0;
    std::int64_t First = 0;
    std::int64_t Last = 0;
};

// What a datagram of our own is, as far as that decides when it goes and how it is counted.
struct OutgoingMessage
{
    // Something in it is of other than builtin endpoints: samples, or what their repair needs.
    bool HasSamples = false;
    // One or more whole samples for one participant and nothing else: where it goes to that one's address
    // alone, it need not say for whom it is (RTPS 2.3, 8.3.4.1: else it is for who receives it).
    bool IsOfSamplesToOne = false;
    // Says that our participant is there, and nothing else; a number that tells one content from another. Not
    // set for a goodbye.
    std::optional<std::uint64_t> Announcement;
    // Set if there is nothing else in it.
    std::optional<FirstRequest> Request;
    std::optional<LoneHeartbeat> Heartbeat;
};

// `datagram` comes from the vendor's writers and is trusted to be sound.
OutgoingMessage ReadOutgoing(std::span<const std::uint8_t> datagram);

// The participant that a datagram is for by its first INFO_DST; zero: none is named.
Rtps::GuidPrefix DestinationOf(std::span<const std::uint8_t> datagram);

// The datagram without what says for whom it is; 16 bytes less.
void WriteWithoutDestination(std::span<const std::uint8_t> datagram, std::vector<std::uint8_t> &to);

// An announcement of a participant without its list of properties, which is of use to the vendor's discovery
// servers only (124 bytes of 420), and without inline QoS (32 bytes where the vendor answers another
// participant).
void WriteWithoutProperties(std::span<const std::uint8_t> announcement, std::vector<std::uint8_t> &to);

// What somebody acknowledges to a writer of ours.
struct Acknowledgement
{
    Rtps::GuidPrefix Peer{};
    Rtps::EntityId Reader = 0;
    Rtps::EntityId Writer = 0;
    std::int64_t Base = 0;  // it has all before this one
    bool Asks = false;      // for repair, or for what there is
};

// Those in a datagram that came; it must be sound, and what is for others must be taken out of it.
std::vector<Acknowledgement> ReadAcknowledgements(std::span<const std::uint8_t> datagram);

}  // namespace Rabit::FastDds
