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

// The card of the own participant, gathered from the datagrams of its DDS implementation: the newest
// announcement of the participant and of each endpoint. The implementation sends announcements of endpoints
// to each known peer until the peer acknowledges. This object is the reader that acknowledges for all peers
// that take cards: it records the numbers that it has seen, and requests the others.
//
// A pure state machine, not thread-safe.
class OwnCard
{
public:
    // Endpoints in a card; the guard accepts as many of one participant (Ledger.h). The newest announcements
    // that an endpoint is gone are kept, so that peers learn of it from the card. If there are more endpoints
    // than this, those gone for longest are left out.
    static constexpr std::size_t MostEndpoints = 1024;

    // Takes a message by which the participant announces itself.
    void Announced(std::span<const std::uint8_t> message);
    // Takes an announcement of an endpoint, a gap or a heartbeat, in the order in which they are sent.
    void Said(const EndpointSubmessage &said);

    // Acknowledgement to an endpoint writer, for the numbers that its last heartbeat named.
    struct Acknowledged
    {
        std::int64_t Base = 1;              // all before this one were seen
        std::vector<std::int64_t> Missing;  // from Base on
    };
    Acknowledged Of(EntityId writer) const;

    // True if Message has changed since the last call. False as long as there is no announcement of the
    // participant.
    bool TakeChanged();
    // The card as one RTPS message, with at most so many endpoints: those that were announced first, and
    // those that are gone behind all others. So an endpoint that is in a card stays in the next one.
    std::vector<std::uint8_t> Message(std::size_t most = MostEndpoints) const;
    // Endpoints that are not gone, and all that are known.
    std::size_t Endpoints() const;
    std::size_t Size() const { return _endpoints.size(); }

private:
    struct Writer
    {
        std::set<std::int64_t> Seen;  // from Base on
        std::int64_t Base = 1;        // all before this one were seen, or will not come
        std::int64_t Last = 0;
    };
    struct Endpoint
    {
        std::int64_t First = 0;   // number of its first announcement
        std::int64_t Number = 0;  // of the newest one
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
