#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

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

    // `period`: of the announcements.
    explicit CardRoutes(std::chrono::milliseconds period) : _listed(period) {}

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
    RecentMap<GuidPrefix, Route> _toOne{Most};
    std::set<Route, Less> _groups;
    RecentRoutes<Route, Less> _listed;
};

}  // namespace Rabit::Rtps
