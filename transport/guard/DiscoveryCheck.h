// Checks the announcements of participants and endpoints before the vendor reads them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/Ledger.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Content of a sound announcement.
struct Announcement
{
    // The participant, or the endpoint; 0 on the topic of liveliness.
    EntityId Subject = 0;
    // Participant: hash of its addresses, its lease and its builtin endpoints. Endpoint: hash of all
    // parameters that we use.
    std::uint64_t Digest = 0;
    // Participant: its name. Endpoint: its topic. Empty unless there is exactly one, without a zero byte in
    // it: two vendors may read different names.
    std::optional<std::string> Name{};
    // Writer: it is best effort.
    bool IsBestEffort = false;
    // Participant: the addresses at which it says it can be reached.
    std::vector<HostAddress> Hosts{};
    // Participant or endpoint: the same with their ports.
    std::vector<Place> Places{};
    // Participant: it listens to a multicast group for samples (PID_DEFAULT_MULTICAST_LOCATOR).
    bool ListensToGroup = false;
    // Participant: it exchanges cards (rtps/Meeting.h). Its digest then omits the lease, which the reader of
    // its card replaces.
    bool HasCard = false;
};

// The longest lease that a participant may announce: the defaults of DDS programs are 10 s to 5 min. With a
// longer one, forged participants would be sent to long after the forger has gone. An honest participant
// renews its lease with each announcement, some seconds to a minute apart.
constexpr std::chrono::seconds LongestLease{300};
enum class Lease
{
    Bounded,  // a longer one is cut in place
    OfCard    // the reader of the card has put it there (rtps/Meeting.h)
};

// Checks the payload of a sample of a discovery or liveliness topic (the known ones of DeliveryCheck.h),
// written by `sender`. The vendor trusts the lengths, counts and identities in it. Bad ones make it read out
// of bounds, allocate gigabytes, or fail an assertion. So every parameter that the vendor would read must be
// whole, and everything must concern the sender itself. Unused parameters are blanked: descriptions of types,
// for instance, which the vendor would parse, and those of DDS Security. Empty if the payload is unsound.
std::optional<Announcement> CheckDiscovery(EntityId writer, const GuidPrefix &sender,
                                           std::span<std::uint8_t> payload, Lease lease = Lease::Bounded);

// Checks the payload of a sample that ends something: a key alone. Returns true if it is whole and names the
// sender itself or one of its endpoints. Fast DDS takes a payload of up to 16 bytes for a key hash, and
// Cyclone DDS reads 16 bytes of a key of liveliness, present or not. Unused parameters are blanked.
bool CheckKey(EntityId writer, const GuidPrefix &sender, std::span<std::uint8_t> payload);
// True if a key hash names the sender itself or one of its endpoints.
bool IsKeyOf(EntityId writer, const GuidPrefix &sender, std::span<const std::uint8_t> keyHash);
// The entity named by a key hash or another GUID of 16 bytes.
EntityId EntityOf(std::span<const std::uint8_t> guid);

}  // namespace Rabit::Rtps
