#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/Ledger.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// At which addresses and ports the proven sessions receive: what goes to a place of one session alone is
// sealed for that session alone. A node that starts again receives at the same places, so the session counts
// that announced itself last. Bounded. Time is passed in. Not thread-safe.
class SessionPlaces
{
public:
    static constexpr std::size_t MostOfOne = 16;
    static constexpr std::size_t Most = 4096;  // sessions

    // The session announced these places, in place of its former ones.
    void Set(SessionTag session, const Hash &certificate, std::span<const Rtps::Place> places);
    void Remove(SessionTag session);
    // The session that alone receives there. Empty: none does, or sessions of several certificates do.
    std::optional<SessionTag> At(const Rtps::Place &place) const;
    std::size_t Size() const { return _sessions.size(); }

private:
    struct Holder
    {
        SessionTag Session = 0;
        Hash Certificate{};
    };

    std::map<Rtps::Place, std::vector<Holder>> _holders;  // the last announced one last
    std::unordered_map<SessionTag, std::vector<Rtps::Place>> _sessions;
};

// The unicast places that a participant announces.
struct AnnouncedPlaces
{
    std::vector<Rtps::Place> All;
    std::vector<Rtps::Place> Discovery;  // those that take discovery data
    bool HasCard = false;                // the participant exchanges cards (rtps/Meeting.h)

    // The first one for discovery data at that host. Empty: there is none.
    std::optional<Rtps::Place> DiscoveryAt(const Rtps::HostAddress &host) const;
};
// Returns the places that the sender of this RTPS message announces for itself. Empty if the message holds no
// sound announcement. Accepts any bytes.
AnnouncedPlaces ReadAnnouncedPlaces(std::span<const std::uint8_t> message);

}  // namespace Rabit::Envelope
