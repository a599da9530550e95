#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "common/RecentMap.h"
#include "common/Rtps.h"

namespace Rabit::FastDds
{

// Announcements of participants, until their senders are authenticated or forgotten.
//
// Fast DDS 3 reads a plain announcement only to begin a handshake. It discovers the participant's endpoints
// when it has a protected announcement (OMG DDS Security 1.1, 7.4). Fast DDS 2.9 and Cyclone DDS say that
// they have the writer of protected announcements, but never send one. So the last plain announcement is
// handed to the vendor again after the handshake, which has confirmed its content
// (guard/AuthenticationRetries.h); or before the goodbye that makes the vendor forget the participant.
// Thread-safe.
class Introductions
{
public:
    enum class Message
    {
        Other,
        Announcement,  // of its sender, and nothing else
        Goodbye
    };

    // As many as the guard knows.
    static constexpr std::size_t MostPeers = 1024;
    static constexpr std::size_t LargestAnnouncement = 4096;

    // Reads a datagram that the guard has admitted, before the vendor sees it. Remembers an announcement.
    // Clears the flags of protected announcements in it: the vendor would exchange keys for them, and Cyclone
    // DDS requests the vendor's again and again.
    Message Read(std::span<std::uint8_t> datagram);

    bool Has(const Rtps::GuidPrefix &sender) const;
    // Takes a participant's last announcement; empty: none.
    std::vector<std::uint8_t> Take(const Rtps::GuidPrefix &sender);

private:
    mutable std::mutex _mutex;
    RecentMap<Rtps::GuidPrefix, std::vector<std::uint8_t>> _announcements{MostPeers};  // guarded by _mutex
};

}  // namespace Rabit::FastDds
