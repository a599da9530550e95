#include "air/DelayReports.h"

#include <iterator>

namespace Rabit
{

void DelayReports::Add(Peer peer, Duration delay, Duration arrivedAt, Duration now)
{
    auto entry =
        std::find_if(_peers.begin(), _peers.end(), [peer](const Entry &known) { return known.Who == peer; });
    if (entry == _peers.end() && _peers.size() < MostPeers)
    {
        entry = _peers.insert(_peers.end(), Entry{peer, {}});
        entry->Said.reserve(MostReports);
    }
    else if (entry == _peers.end())
    {
        entry = std::min_element(_peers.begin(), _peers.end(),
                                 [](const Entry &a, const Entry &b)
                                 { return a.Said.back().CameAt < b.Said.back().CameAt; });
        entry->Who = peer;
        entry->Said.clear();
    }
    std::erase_if(entry->Said, [now](const Report &report) { return now - report.CameAt > Oldest; });
    if (entry->Said.size() == MostReports)
    {
        entry->Said.erase(entry->Said.begin());
    }
    entry->Said.push_back({now, std::min(arrivedAt, now), std::max(delay, Duration(0))});
}

const DelayReports::Reports *DelayReports::Of(Peer peer) const
{
    const auto entry =
        std::find_if(_peers.begin(), _peers.end(), [peer](const Entry &known) { return known.Who == peer; });
    return entry == _peers.end() ? nullptr : &entry->Said;
}

std::optional<DelayReports::Duration> DelayReports::Latest(Duration now) const
{
    return MedianOf([](const Reports &said) { return std::optional(said.back().Delay); }, now);
}

bool DelayReports::IsFresh(const Entry &entry, Duration now)
{
    return now - entry.Said.back().CameAt <= Fresh;
}

// The first of the last reports in a row with a delay above `later`; the end if the last report has none.
DelayReports::Reports::const_iterator DelayReports::FirstLate(const Reports &said, Duration later)
{
    auto first = said.end();
    while (first != said.begin() && std::prev(first)->Delay > later)
    {
        --first;
    }
    return first;
}

bool DelayReports::IsContradicted(const Entry &entry, const Report &first, Duration later, Duration now) const
{
    return std::any_of(_peers.begin(), _peers.end(),
                       [&](const Entry &other)
                       {
                           return other.Who != entry.Who && IsFresh(other, now) &&
                                  other.Said.back().Delay <= later &&
                                  other.Said.back().SentAt() >= first.SentAt();
                       });
}

bool DelayReports::Agree(Duration later, Duration now) const
{
    const auto peers = std::count_if(_peers.begin(), _peers.end(),
                                     [now](const Entry &entry) { return IsFresh(entry, now); });
    const std::ptrdiff_t wanted = peers > 3 ? 1 : peers > 1 ? 2 : 3;
    std::ptrdiff_t agreeing = 0;
    for (const Entry &entry : _peers)
    {
        const auto first = FirstLate(entry.Said, later);
        const auto late = entry.Said.end() - first;
        if (!IsFresh(entry, now) || late == 0)
        {
            continue;
        }
        if (late >= 3 && entry.Said.back().CameAt - first->CameAt >= LongEnough &&
            !IsContradicted(entry, *first, later, now))
        {
            return true;
        }
        agreeing += late >= wanted ? 1 : 0;
    }
    return agreeing > peers / 2;
}

}  // namespace Rabit
