// The datagrams by which nodes exchange their cards.
//
// Each is an RTPS message of one vendor-specific submessage (OMG DDSI-RTPS 2.3, 9.4.5.1.1). Its vendor number
// is unassigned, so that DDS programs ignore it. All numbers are little-endian:
//
//   offset  size  of the submessage's body
//   0       1     format, 2
//   1       1     number of requests
//   2       1     which part follows the requests
//   3       1     1 if a part follows, else 0
//   4       8     digest of the sender's card
//   12      4     size of the sender's packed card; 0: it has none yet
//   16      4     when it was sent, in ms of the sender's monotonic clock (QueueingDelay.h)
//   20      20 n  requests: GUID prefix of the node that is asked (12), a bit for each part that it
//                 lacks (8)
//   ...     16    if a part follows: whose request it answers (GUID prefix; zero: nobody's), and when
//                 that one was sent, by its sender's clock, plus the time for which it was held back (4)
//   ...           the part, padded with zeros to a multiple of 4, or more if the message would end
//                 like statistics of Fast DDS (guard/RtpsMessage.h): the vendor's sockets would write
//                 into it
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Identifies one version of a node's card.
struct CardSummary
{
    std::uint64_t Digest = 0;  // of the packed card (PackedCard.h)
    std::uint32_t Size = 0;    // of the packed card, in bytes; 0: there is none yet
    bool operator==(const CardSummary &) const = default;

    std::size_t Parts() const;
    // A bit for each part.
    std::uint64_t AllParts() const;
};

struct CardRequest
{
    GuidPrefix Of{};          // the node that is asked for parts of its card
    std::uint64_t Parts = 0;  // bit k: part k is missing; all bits: the requester knows nothing of the card
};

// The request that a part answers, so that its sender learns how long the answer took.
struct AnsweredRequest
{
    GuidPrefix From{};         // zero: nobody has asked
    std::uint32_t SentAt = 0;  // plus the time for which the answer was held back
};

struct CardMessage
{
    GuidPrefix From{};
    CardSummary Summary{};  // of the sender's card
    std::uint32_t SentAt = 0;
    std::vector<CardRequest> Requests{};
    bool HasPart = false;
    std::size_t Part = 0;
    AnsweredRequest Answers{};              // the request that the part answers
    std::span<const std::uint8_t> Bytes{};  // of the part; borrowed
};

// Bytes of each part but the last. With all headers a datagram stays below the MTU of radios.
constexpr std::size_t CardPartSize = 1000;
constexpr std::size_t MostCardParts = 64;
constexpr std::size_t LargestCard = MostCardParts * CardPartSize;
// Limit of requests in one message, so that a full message fits a datagram.
constexpr std::size_t MostCardRequests = 40;

// True if a datagram claims to be a card message. Accepts any bytes.
bool IsCardMessage(std::span<const std::uint8_t> datagram);
// Empty if the bytes are not a sound message. `Bytes` refers to the datagram.
std::optional<CardMessage> ReadCardMessage(std::span<const std::uint8_t> datagram);
std::vector<std::uint8_t> WriteCardMessage(const CardMessage &message);
// Bytes of a message with so many requests and, if `part` is not 0, a part of that size, without padding.
std::size_t CardMessageSize(std::size_t requests, std::size_t part);

}  // namespace Rabit::Rtps
