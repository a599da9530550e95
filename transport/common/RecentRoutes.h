#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <vector>

namespace Rabit
{

// The routes by which announcements to listed peers went a short while ago. The vendor announces the
// participant to each of them once a period, and stops when a participant that it has heard there is gone: so
// a route without an announcement for some periods leads to nobody. Bounded; not thread-safe.
template <typename Route, typename Order = std::less<Route>>
class RecentRoutes
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    static constexpr std::size_t Most = 4096;
    // One announcement may be held back, and one may be lost to a busy machine.
    static constexpr int Periods = 3;

    explicit RecentRoutes(std::chrono::milliseconds period) : _lifetime(Periods * period) {}

    // An announcement goes that way.
    void Note(const Route &route, TimePoint now)
    {
        if (_routes.size() < Most || _routes.contains(route))
        {
            _routes.insert_or_assign(route, now);
        }
    }
    // The routes that are in use.
    std::vector<Route> Current(TimePoint now)
    {
        std::erase_if(_routes, [&](const auto &route) { return now - route.second > _lifetime; });
        std::vector<Route> routes;
        for (const auto &[route, at] : _routes)
        {
            routes.push_back(route);
        }
        return routes;
    }

private:
    const std::chrono::milliseconds _lifetime;
    std::map<Route, TimePoint, Order> _routes;
};

}  // namespace Rabit
