#include "RepairPace.h"

#include <algorithm>

namespace Rabit::FastDds
{

void RepairPace::Begin(Round &round, TimePoint now)
{
    round.Gap = now - round.Begun >= Rest ? FirstGap : std::min(2 * round.Gap, LongestGap);
    round.Begun = now;
    round.Owed = false;
}

bool RepairPace::MayGo(std::uint64_t content, TimePoint now)
{
    const auto found = _rounds.find(content);
    if (found == _rounds.end())
    {
        if (_rounds.size() >= MostContents)
        {
            std::erase_if(_rounds, [now](const auto &round) { return now - round.second.Begun >= Rest; });
        }
        if (_rounds.size() < MostContents)
        {
            _rounds.emplace(content, Round{.Begun = now});
        }
        return true;
    }
    Round &round = found->second;
    if (now - round.Begun < round.Gap)
    {
        round.Owed = true;
        return false;
    }
    Begin(round, now);
    return true;
}

std::optional<RepairPace::TimePoint> RepairPace::Due() const
{
    std::optional<TimePoint> due;
    for (const auto &[content, round] : _rounds)
    {
        if (round.Owed && (!due || round.Begun + round.Gap < *due))
        {
            due = round.Begun + round.Gap;
        }
    }
    return due;
}

std::vector<std::uint64_t> RepairPace::TakeDue(TimePoint now)
{
    std::vector<std::uint64_t> due;
    for (auto &[content, round] : _rounds)
    {
        if (round.Owed && now - round.Begun >= round.Gap)
        {
            Begin(round, now);
            due.push_back(content);
        }
    }
    return due;
}

}  // namespace Rabit::FastDds
