#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "rtps/DiscoverySubmessages.h"

namespace Rabit::Rtps
{

// The card of the own participant, gathered from what its DDS implementation says to others: the newest
// announcement of the participant and of each endpoint. The implementation says its endpoints to each peer
// that it knows, until the peer acknowledges. This object is the reader that acknowledges for all peers that
// take cards: it knows which numbers it has seen, and asks for the others.
//
// A pure state machine, not thread-safe.
class OwnCard
{
public:
    // The newest announcements that say that an endpoint is gone are kept, so that peers learn of it from the
    // card. Of more endpoints than this the ones that are gone for longest are left out.
    static constexpr std::size_t MostEndpoints = 1024;

    // A message by which the participant announces itself.
    void Announced(std::span<const std::uint8_t> message);
    // An announcement of an endpoint, a gap or a heartbeat, in the order in which they are said.
    void Said(const EndpointSubmessage &said);

    // The acknowledgement to an endpoint writer, of the numbers that its last heartbeat named.
    struct Acknowledged
    {
        std::int64_t Base = 1;              // all before have been seen
        std::vector<std::int64_t> Missing;  // from there on
    };
    Acknowledged Of(EntityId writer) const;

    // Whether Message has changed since this was asked. False as long as there is no announcement.
    bool TakeChanged();
    // The card as one RTPS message.
    std::vector<std::uint8_t> Message() const;

private:
    struct Writer
    {
        std::set<std::int64_t> Seen;  // beyond Base
        std::int64_t Base = 1;        // all before have been seen, or will not come
        std::int64_t Last = 0;
    };
    struct Endpoint
    {
        std::int64_t Number = 0;
        std::uint64_t Content = 0;
        bool Alive = true;
        std::vector<std::uint8_t> Announcement;
    };

    void See(Writer &writer, std::int64_t number);
    void Put(const EndpointSubmessage &said);
    void LeaveOutOldest();

    std::vector<std::uint8_t> _header;
    std::vector<std::uint8_t> _participant;  // its announcement
    std::uint64_t _participantContent = 0;
    std::map<EntityId, Writer> _writers;
    std::map<std::pair<EntityId, EntityId>, Endpoint> _endpoints;  // the writer first
    bool _changed = false;
};

}  // namespace Rabit::Rtps
