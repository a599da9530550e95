#include "presence/MissingOffers.h"

#include <algorithm>

#include "names/TakeTurns.h"

namespace Rabit
{

void MissingOffers::Lacks(const std::string &node, std::uint32_t digest, Duration now)
{
    const auto [found, isNew] = _lacking.try_emplace(node);
    if (isNew)
    {
        found->second.AskAt = now + AskAfter;
    }
    found->second.Digest = digest;
}

std::optional<std::vector<std::uint8_t>> MissingOffers::Add(const std::string &node,
                                                            const Gateway::AnnouncementPart &part)
{
    const auto found = _lacking.find(node);
    if (found == _lacking.end())
    {
        return std::nullopt;
    }
    Entry &entry = found->second;
    switch (entry.Collected.Add(entry.Digest, part))
    {
        case OffersCollector::Outcome::Complete:
            return entry.Collected.Bytes();
        case OffersCollector::Outcome::Wrong:
            ++_wrong;
            break;
        case OffersCollector::Outcome::Incomplete:
            break;
    }
    return std::nullopt;
}

std::optional<MissingOffers::Duration> MissingOffers::NextDue() const
{
    std::optional<Duration> next;
    for (const auto &[node, entry] : _lacking)
    {
        next = std::min(next.value_or(entry.AskAt), entry.AskAt);
    }
    return next;
}

std::size_t MissingOffers::Due(Duration now, std::size_t most) const
{
    const auto due = std::count_if(_lacking.begin(), _lacking.end(),
                                   [now](const auto &entry) { return entry.second.AskAt <= now; });
    return std::min(static_cast<std::size_t>(due), most);
}

std::vector<MissingOffers::Question> MissingOffers::Take(Duration now, std::size_t most, Duration delay)
{
    std::vector<Question> questions;
    TakeTurns(_lacking, _lastAsked, most,
              [&](const std::string &node, Entry &entry)
              {
                  if (entry.AskAt > now)
                  {
                      return false;
                  }
                  questions.push_back({node, entry.Collected.FirstLacking(entry.Digest)});
                  entry.AskAt = now + std::max(entry.Gap, 2 * delay);
                  const bool quick = ++entry.Asked < _quickQuestions;
                  entry.Gap = std::min(entry.Gap * 3 / 2, quick ? _quickGap : LongestGap);
                  return true;
              });
    return questions;
}

}  // namespace Rabit
