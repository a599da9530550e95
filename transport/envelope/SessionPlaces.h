#pragma once

#include <cstddef>
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

// The unicast places that the participant announces which sent this RTPS message. Empty if the message holds
// no sound announcement. Accepts any bytes.
std::vector<Rtps::Place> AnnouncedPlaces(std::span<const std::uint8_t> message);

}  // namespace Rabit::Envelope
