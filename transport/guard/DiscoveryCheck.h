// What the vendor is told by participants and endpoints of themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// What a sound announcement is about.
struct Announcement
{
    // The participant, or the endpoint; 0 on the topic of liveliness.
    EntityId Subject = 0;
    // Of a participant: of what says where it is heard. Of an endpoint: of all that we have a use for.
    std::uint64_t Digest = 0;
    // Of a writer: that it repeats nothing.
    bool IsBestEffort = false;
    // Of a participant: where it says that it can be reached.
    std::vector<HostAddress> Hosts{};
    // Of a participant: that it listens to a multicast group for samples (PID_DEFAULT_MULTICAST_LOCATOR).
    bool ListensToGroup = false;
    // Of a participant: that it exchanges cards (rtps/Meeting.h). Its digest leaves out the lease, which its
    // card's reader replaces.
    bool HasCard = false;
};

// Checks the payload of a sample of one of the topics of discovery or liveliness (the known ones of
// DeliveryCheck.h), written by `sender`. The vendor believes lengths, counts and identities in there and can
// be made to read outside of them, to allocate gigabytes, or to fail an assertion; so every parameter that it
// would read has to be whole, and everything has to be about the sender itself. Parameters that we have no
// use for are blanked: descriptions of types, for instance, which the vendor would take apart; and what DDS
// Security has to say unless it is `secured`. Nothing if it is unsound.
std::optional<Announcement> CheckDiscovery(EntityId writer, const GuidPrefix &sender,
                                           std::span<std::uint8_t> payload, bool secured);

// Whether a key hash names something of the sender's: itself, or one of its endpoints.
bool IsKeyOf(EntityId writer, const GuidPrefix &sender, std::span<const std::uint8_t> keyHash);
// The entity that a key hash, or another GUID of 16 bytes, names.
EntityId EntityOf(std::span<const std::uint8_t> guid);

}  // namespace Rabit::Rtps
