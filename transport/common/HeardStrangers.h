#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <vector>

#include "common/Ledger.h"

namespace Rabit::Rtps
{

// Where nodes may wait for what introduces this one, since their last datagrams told guard and vendor
// nothing. Bounded. Time is passed in. Not thread-safe.
class HeardStrangers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // If there are more, the one that was heard last the longest time ago is forgotten.
    static constexpr std::size_t Most = 16;
    // After the last datagram from there: nodes repeat what introduces them.
    static constexpr std::chrono::seconds Remembered{3};

    // `at`: where the node takes discovery data. With port 0 nothing but its host is known.
    void Heard(const Place &at, TimePoint now)
    {
        if (_places.size() >= Most && !_places.contains(at))
        {
            _places.erase(std::min_element(_places.begin(), _places.end(),
                                           [](const auto &a, const auto &b) { return a.second < b.second; }));
        }
        _places.insert_or_assign(at, now);
    }
    std::vector<Place> Current(TimePoint now)
    {
        std::erase_if(_places, [now](const auto &entry) { return now - entry.second > Remembered; });
        std::vector<Place> current;
        for (const auto &[place, heard] : _places)
        {
            current.push_back(place);
        }
        return current;
    }

private:
    std::map<Place, TimePoint> _places;  // when they were heard last
};

}  // namespace Rabit::Rtps
