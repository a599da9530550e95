#include "presence/MissingOffers.h"

#include "names/TakeTurns.h"

namespace Rabit
{

void MissingOffers::Lacks(const std::string &node, std::uint32_t digest, Duration now)
{
    const auto [found, isNew] = _lacking.try_emplace(node, _gaps);
    if (isNew)
    {
        found->second.Ask.Begin(now + AskAfter);
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
    return NextAsk(_lacking);
}

std::size_t MissingOffers::Due(Duration now, std::size_t most) const
{
    return CountAsks(_lacking, now, most);
}

std::vector<MissingOffers::Question> MissingOffers::Take(Duration now, std::size_t most, Duration delay)
{
    std::vector<Question> questions;
    TakeTurns(_lacking, _lastAsked, most,
              [&](const std::string &node, Entry &entry)
              {
                  if (!entry.Ask.IsDue(now))
                  {
                      return false;
                  }
                  questions.push_back({node, entry.Collected.FirstLacking(entry.Digest)});
                  entry.Ask.Done(now, 2 * delay);
                  return true;
              });
    return questions;
}

}  // namespace Rabit
