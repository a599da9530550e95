#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <vector>

#include "common/Rtps.h"

namespace Rabit::Rtps
{

// The hosts whose last datagrams told guard and vendor nothing: nodes there may wait for what introduces this
// one. Bounded. Time is passed in. Not thread-safe.
class HeardStrangers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // If there are more, the one that was heard last the longest time ago is forgotten.
    static constexpr std::size_t Most = 16;
    // After a host's last datagram: nodes repeat what introduces them.
    static constexpr std::chrono::seconds Remembered{3};

    void Heard(const HostAddress &host, TimePoint now)
    {
        if (_hosts.size() >= Most && !_hosts.contains(host))
        {
            _hosts.erase(std::min_element(_hosts.begin(), _hosts.end(),
                                          [](const auto &a, const auto &b) { return a.second < b.second; }));
        }
        _hosts.insert_or_assign(host, now);
    }
    std::vector<HostAddress> Current(TimePoint now)
    {
        std::erase_if(_hosts, [now](const auto &entry) { return now - entry.second > Remembered; });
        std::vector<HostAddress> current;
        for (const auto &[host, heard] : _hosts)
        {
            current.push_back(host);
        }
        return current;
    }

private:
    std::map<HostAddress, TimePoint> _hosts;  // when they were heard last
};

}  // namespace Rabit::Rtps
