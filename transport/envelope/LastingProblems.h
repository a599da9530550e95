#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <rabit/transport/Transport.h>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Says how long a problem has to last, and what ends it besides a pause.
enum class ProblemKind : std::uint8_t
{
    Usual,
    WithoutKeys,  // a program without keys that hears nobody sends its announcements alone, each 10 to 30 s
    UnknownEpoch  // a newer bulletin ends it
};

// Problems that are noted again and again. One becomes a row for people once it was noted in some different
// seconds without a pause, and stays until the pause. Bounded. Time is passed in. Not thread-safe.
class LastingProblems
{
public:
    static constexpr std::size_t Most = 64;

    // Different seconds in which a problem is noted before it is a row.
    static constexpr int SecondsOf(ProblemKind kind) { return kind == ProblemKind::WithoutKeys ? 5 : 10; }
    // Longest time between two notes of a problem that lasts.
    static constexpr std::chrono::seconds PauseOf(ProblemKind kind)
    {
        return std::chrono::seconds(kind == ProblemKind::WithoutKeys ? 100 : 10);
    }

    // `entry`: the node or address.
    void Note(const std::string &entry, const std::string &text, ProblemKind kind, TimePoint now)
    {
        const std::pair key(entry, text);
        const auto found = _noted.find(key);
        if (found == _noted.end())
        {
            MakeRoom(now);
            _noted.emplace(key, Noted{.Last = now, .Seconds = 1, .Kind = kind});
            return;
        }
        Noted &noted = found->second;
        if (noted.HasPaused(now))
        {
            noted.Seconds = 0;
        }
        noted.Seconds += noted.Seconds == 0 || SecondOf(now) != SecondOf(noted.Last) ? 1 : 0;
        noted.Last = now;
    }

    // All problems of this kind are over.
    void End(ProblemKind kind)
    {
        std::erase_if(_noted, [kind](const auto &each) { return each.second.Kind == kind; });
    }

    // All that lasts. `Setting` is `security`.
    std::vector<SettingsProblem> Rows(TimePoint now) const
    {
        std::vector<SettingsProblem> rows;
        for (const auto &[key, noted] : _noted)
        {
            if (noted.HasLasted() && !noted.HasPaused(now))
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
        ProblemKind Kind = ProblemKind::Usual;

        bool HasPaused(TimePoint now) const { return now - Last > PauseOf(Kind); }
        bool HasLasted() const { return Seconds >= SecondsOf(Kind); }
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
        std::erase_if(_noted, [now](const auto &each) { return each.second.HasPaused(now); });
        if (_noted.size() >= Most)
        {
            // Lasting problems are kept: addresses can be forged, one after the other.
            const auto rank = [](const Noted &noted) { return std::pair(noted.HasLasted(), noted.Seconds); };
            _noted.erase(std::min_element(_noted.begin(), _noted.end(),
                                          [&rank](const auto &a, const auto &b)
                                          { return rank(a.second) < rank(b.second); }));
        }
    }

    std::map<std::pair<std::string, std::string>, Noted> _noted;
};

}  // namespace Rabit::Envelope
