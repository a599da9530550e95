#include "presence/SenderCheck.h"

#include <algorithm>

namespace Rabit
{

bool SenderCheck::Refuse(std::string_view participant, std::string_view named, Duration now)
{
    const std::lock_guard lock(_mutex);
    ++_refused;
    Remember(participant, named, now);
    return false;
}

void SenderCheck::Remember(std::string_view participant, std::string_view named, Duration now)
{
    const Claim claim{participant, named};
    if (_claims.size() >= MostRemembered && _claims.count(claim) == 0)
    {
        _claims.erase(std::min_element(_claims.begin(), _claims.end(),
                                       [](const auto &a, const auto &b) { return a.second < b.second; }));
    }
    _claims[claim] = now;
}

std::uint64_t SenderCheck::Refused() const
{
    const std::lock_guard lock(_mutex);
    return _refused;
}

std::vector<Gateway::Problem> SenderCheck::Problems(Duration now) const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> problems;
    for (const auto &[claim, seen] : _claims)
    {
        if (now - seen > Memory)
        {
            continue;
        }
        Gateway::Problem problem;
        problem.subject = "node " + claim.second;
        problem.node = claim.first;
        problem.reason = (claim.first.empty() ? "a program that is no node" : "node `" + claim.first + "`") +
                         " sends in the name of `" + claim.second + "`; it is not listened to";
        problems.push_back(std::move(problem));
    }
    return problems;
}

}  // namespace Rabit
