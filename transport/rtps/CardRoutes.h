#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/Ledger.h"
#include "common/RecentMap.h"
#include "common/RecentRoutes.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// The routes by which cards reach other nodes, as the own DDS implementation uses them. Route: a way from one
// of its sockets to an address. Not thread-safe.
template <typename Route, typename Less = std::less<Route>>
class CardRoutes
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    static constexpr std::size_t Most = 4096;
    // Participants that were heard. Each gets this node's card and requests for its own.
    static constexpr std::size_t MostHeard = 64;

    // `period`: of the announcements.
    explicit CardRoutes(std::chrono::milliseconds period)
        : _listed(period), _remembered(RecentRoutes<Route, Less>::Periods * period)
    {
    }

    // The implementation sends to that participant alone.
    void Note(const GuidPrefix &to, const Route &route)
    {
        if (to != GuidPrefix{})
        {
            _toOne.Put(to, route);
        }
    }
    // The implementation announces its participant to a group, or to a listed peer (RecentRoutes).
    void NoteForAll(const Route &route, bool isGroup, TimePoint now)
    {
        isGroup ? static_cast<void>(_groups.insert(route)) : _listed.Note(route, now);
    }
    // The participant has announced that it takes discovery data there. For nodes without multicast: the
    // implementation sends nothing to a participant before it knows it by its card.
    void NoteHeard(const GuidPrefix &from, const Place &at, TimePoint now)
    {
        std::erase_if(_heard, [&](const auto &entry)
                      { return now - entry.second.second > _remembered || HasRoute(entry.first); });
        if (!HasRoute(from) && (_heard.size() < MostHeard || _heard.contains(from)))
        {
            _heard.insert_or_assign(from, std::pair(at, now));
        }
    }
    // Where a participant was heard to which the implementation has sent nothing; all of them if it is empty.
    std::vector<Place> HeardAt(const std::optional<GuidPrefix> &participant, TimePoint now) const
    {
        std::vector<Place> places;
        for (const auto &[from, at] : _heard)
        {
            if ((!participant || *participant == from) && now - at.second <= _remembered && !HasRoute(from))
            {
                places.push_back(at.first);
            }
        }
        return places;
    }
    // The routes to a participant, or to all if it is empty or not known.
    std::vector<Route> To(const std::optional<GuidPrefix> &participant, TimePoint now)
    {
        if (const Route *const one = participant ? _toOne.Find(*participant) : nullptr)
        {
            return {*one};
        }
        std::vector<Route> routes = _listed.Current(now);
        routes.insert(routes.begin(), _groups.begin(), _groups.end());
        return routes;
    }

private:
    bool HasRoute(const GuidPrefix &to) const { return _toOne.Find(to) != nullptr; }

    RecentMap<GuidPrefix, Route> _toOne{Most};
    std::set<Route, Less> _groups;
    RecentRoutes<Route, Less> _listed;
    const std::chrono::milliseconds _remembered;
    std::map<GuidPrefix, std::pair<Place, TimePoint>> _heard;  // with the time of the last announcement
};

}  // namespace Rabit::Rtps
