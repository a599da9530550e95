#include "common/AuthorityRefusals.h"

#include <algorithm>

namespace Rabit::Rtps
{

void AuthorityRefusals::Refused(const GuidPrefix &peer, EntityId subject, Row row, TimePoint now)
{
    const std::pair key{peer, subject};
    const std::lock_guard lock(_mutex);
    if (_refusals.size() >= Most && !_refusals.contains(key))
    {
        _refusals.erase(std::min_element(_refusals.begin(), _refusals.end(),
                                         [](const auto &a, const auto &b)
                                         { return a.second.Last < b.second.Last; }));
    }
    const auto [found, isNew] = _refusals.try_emplace(key);
    Refusal &refusal = found->second;
    if (isNew || (subject == ParticipantEntity && now - refusal.Last > Repeated))
    {
        refusal.Began = now;
    }
    refusal.What = std::move(row);
    refusal.Last = now;
}

void AuthorityRefusals::Gone(const GuidPrefix &peer, EntityId subject)
{
    const std::lock_guard lock(_mutex);
    _refusals.erase({peer, subject});
}

void AuthorityRefusals::Left(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    std::erase_if(_refusals, [&peer](const auto &entry) { return entry.first.first == peer; });
}

std::vector<AuthorityRefusals::Row> AuthorityRefusals::LastingRefusals(TimePoint now) const
{
    const std::lock_guard lock(_mutex);
    std::vector<Row> lasting;
    for (const auto &[key, refusal] : _refusals)
    {
        const bool stands = key.second != ParticipantEntity || now - refusal.Last <= Repeated;
        if (stands && now - refusal.Began >= Lasting)
        {
            lasting.push_back(refusal.What);
        }
    }
    return lasting;
}

}  // namespace Rabit::Rtps
