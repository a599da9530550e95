// The datagrams of an agreement. Numbers are little-endian; a name is a byte for its length, and its bytes.
//
//   request: 1, group (8), incarnation (8), session (4), renewal (4), book (8), number (4), count (1), orders
//   order:   kind (1), fence (8), name
//   reply:   2, group (8), incarnation (8), claimant's incarnation (8) and session (4), book (8),
//            renewal (4), number (4), fences (8), count (1), results
//   result:  kind (1), milliseconds (4), name, holder
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace Rabit
{

// An order of a claimant to a voter about one claim. All are safe to repeat.
struct ClaimOrder
{
    enum class Kind : std::uint8_t
    {
        Ask,     // keep the claim for me
        Accept,  // I hold it, under this fence
        Release  // keep it no longer
    };

    Kind What = Kind::Ask;
    std::uint64_t Fence = 0;  // of Accept
    std::string Name;
    bool operator==(const ClaimOrder &) const = default;
};

// From a claimant to a voter. Without orders it renews the lease alone, and goes to all.
struct ClaimRequest
{
    // The reply fits in a datagram of 1,200 bytes: it has 54 bytes, and 271 more for each order if both names
    // are as long as they may be.
    static constexpr std::size_t MostOrders = 4;

    std::uint64_t Group = 0;  // AgreementSettings::Group
    std::uint64_t Incarnation = 0;
    std::uint32_t Session = 0;  // of this incarnation: another one after each standstill of its clock
    std::uint32_t Renewal = 0;  // rising with each request of the session
    // The voter's book (ClaimReply) that the orders are for; 0: not known. So a late copy of an order does
    // nothing in a later book.
    std::uint64_t Book = 0;
    std::uint32_t Number = 0;  // rising with each request that has orders
    std::vector<ClaimOrder> Orders{};
    bool operator==(const ClaimRequest &) const = default;
};

struct ClaimResult
{
    enum class Kind : std::uint8_t
    {
        Granted,
        Accepted,
        Released,
        Refused  // another one has it, or the claimant has too many; an Accept without a grant
    };

    Kind What = Kind::Refused;
    // Of Refused: until the voter's record of the holder ends, if it is not renewed. 0: the other one has not
    // accepted yet, and may give way.
    std::uint32_t Milliseconds = 0;
    std::string Name;
    std::string Holder{};  // of Refused; empty: none
    bool operator==(const ClaimResult &) const = default;
};

// From a voter to a claimant.
struct ClaimReply
{
    std::uint64_t Group = 0;
    std::uint64_t Incarnation = 0;  // of the voter
    std::uint64_t Claimant = 0;     // incarnation
    std::uint32_t Session = 0;      // of the claimant
    // Names the voter's record of this session. A record that ended took all grants with it.
    std::uint64_t Book = 0;
    std::uint32_t Renewal = 0;  // the newest that came
    std::uint32_t Number = 0;   // of the request that the results are for
    std::uint64_t Fences = 0;   // no fence above this one was given, as far as the voter knows
    std::vector<ClaimResult> Results{};
    bool operator==(const ClaimReply &) const = default;
};

// `orders` and `results` must have at most MostOrders entries, and names at most 255 bytes.
std::vector<std::uint8_t> EncodeClaimRequest(const ClaimRequest &request);
std::vector<std::uint8_t> EncodeClaimReply(const ClaimReply &reply);
// Accept any bytes; empty if they are none, or a name is empty or longer than a claim's may be.
std::optional<ClaimRequest> DecodeClaimRequest(std::span<const std::uint8_t> bytes);
std::optional<ClaimReply> DecodeClaimReply(std::span<const std::uint8_t> bytes);

}  // namespace Rabit
