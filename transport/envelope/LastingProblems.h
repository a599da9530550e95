#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <rabit/transport/Transport.h>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Problems that are noted again and again. One becomes a row for people once it was noted in LastingSeconds
// different seconds without a pause, and stays until the pause. Bounded. Time is passed in. Not thread-safe.
class LastingProblems
{
public:
    static constexpr int LastingSeconds = 10;
    static constexpr std::chrono::seconds Pause{10};
    static constexpr std::size_t Most = 64;

    // `entry`: the node or address.
    void Note(const std::string &entry, const std::string &text, TimePoint now)
    {
        const std::pair key(entry, text);
        const auto found = _noted.find(key);
        if (found == _noted.end())
        {
            MakeRoom(now);
            _noted.emplace(key, Noted{.Last = now, .Seconds = 1});
            return;
        }
        Noted &noted = found->second;
        if (now - noted.Last > Pause)
        {
            noted.Seconds = 0;
        }
        noted.Seconds += noted.Seconds == 0 || SecondOf(now) != SecondOf(noted.Last) ? 1 : 0;
        noted.Last = now;
    }

    // All that lasts. `Setting` is `security`.
    std::vector<SettingsProblem> Rows(TimePoint now) const
    {
        std::vector<SettingsProblem> rows;
        for (const auto &[key, noted] : _noted)
        {
            if (noted.Seconds >= LastingSeconds && now - noted.Last <= Pause)
            {
                rows.push_back({.Setting = "security", .Entry = key.first, .Text = key.second});
            }
        }
        return rows;
    }

    std::size_t Size() const { return _noted.size(); }

private:
    struct Noted
    {
        TimePoint Last{};
        int Seconds = 0;  // different ones
    };

    static std::chrono::seconds SecondOf(TimePoint time)
    {
        return std::chrono::floor<std::chrono::seconds>(time.time_since_epoch());
    }

    void MakeRoom(TimePoint now)
    {
        if (_noted.size() < Most)
        {
            return;
        }
        std::erase_if(_noted, [now](const auto &each) { return now - each.second.Last > Pause; });
        if (_noted.size() >= Most)
        {
            // Lasting problems are kept: addresses can be forged, one after the other.
            _noted.erase(std::min_element(_noted.begin(), _noted.end(),
                                          [](const auto &a, const auto &b)
                                          { return a.second.Seconds < b.second.Seconds; }));
        }
    }

    std::map<std::pair<std::string, std::string>, Noted> _noted;
};

}  // namespace Rabit::Envelope
