#include "agreement/ClaimVotes.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

ClaimVotes::ClaimVotes(std::string claim, const std::vector<std::string> &voters) : _claim(std::move(claim))
{
    for (const std::string &voter : voters)
    {
        _votes.emplace(voter, Vote());
    }
}

void ClaimVotes::Aims(Aim aim)
{
    _aim = aim;
    for (auto &[name, vote] : _votes)
    {
        vote.Since = 0;
    }
}

void ClaimVotes::Ask()
{
    Aims(Aim::Grants);
    _fence = 0;
    for (auto &[name, vote] : _votes)
    {
        vote.What = Kind::Unknown;
    }
}

void ClaimVotes::Accept()
{
    Aims(Aim::Acceptances);
    for (const auto &[name, vote] : _votes)
    {
        _fence = vote.What == Kind::Granted ? std::max(_fence, vote.Fences + 1) : _fence;
    }
}

void ClaimVotes::Release()
{
    Aims(Aim::Release);
}

void ClaimVotes::AskRefusedAgain()
{
    for (auto &[name, vote] : _votes)
    {
        if (vote.What == Kind::Refused)
        {
            vote = {.WasAsked = vote.WasAsked};
        }
    }
}

void ClaimVotes::ForgetBookOf(std::string_view voter)
{
    Of(voter) = Vote();
}

void ClaimVotes::ForgetAll()
{
    for (auto &[name, vote] : _votes)
    {
        vote = Vote();
    }
}

std::optional<ClaimOrder> ClaimVotes::OrderTo(std::string_view voter) const
{
    const Vote &vote = Of(voter);
    if (_aim == Aim::Release)
    {
        return vote.WasAsked ? std::optional(ClaimOrder{.What = ClaimOrder::Kind::Release, .Name = _claim})
                             : std::nullopt;
    }
    if (vote.What == Kind::Unknown)
    {
        return ClaimOrder{.What = ClaimOrder::Kind::Ask, .Name = _claim};
    }
    if (vote.What == Kind::Granted && _aim != Aim::Grants)
    {
        return ClaimOrder{.What = ClaimOrder::Kind::Accept, .Fence = _fence, .Name = _claim};
    }
    return std::nullopt;
}

bool ClaimVotes::IsUnsent(std::string_view voter) const
{
    return Of(voter).Since == 0 && OrderTo(voter).has_value();
}

void ClaimVotes::Sent(std::string_view voter, std::uint32_t number)
{
    Vote &vote = Of(voter);
    vote.Since = vote.Since == 0 ? number : vote.Since;
    vote.WasAsked = true;
}

bool ClaimVotes::Take(std::string_view voter, std::uint32_t number, std::uint64_t fences,
                      const ClaimResult &result)
{
    Vote &vote = Of(voter);
    // An answer to an earlier order says nothing of the present one.
    if (vote.Since == 0 || number < vote.Since)
    {
        return false;
    }
    vote.Since = 0;
    switch (result.What)
    {
        case ClaimResult::Kind::Granted:
            return TakeGrant(vote, fences);
        case ClaimResult::Kind::Accepted:
            vote.What = Kind::Accepted;
            break;
        case ClaimResult::Kind::Released:
            vote = Vote();
            break;
        case ClaimResult::Kind::Refused:
            vote.What = Kind::Refused;
            vote.Holder = result.Holder;
            vote.Wait = std::chrono::milliseconds(result.Milliseconds);
            break;
    }
    return false;
}

bool ClaimVotes::TakeGrant(Vote &vote, std::uint64_t fences)
{
    vote.What = Kind::Granted;
    vote.Fences = fences;
    if (_aim != Aim::Acceptances || fences < _fence)
    {
        return false;
    }
    _fence = fences + 1;
    for (auto &[name, other] : _votes)
    {
        if (other.What == Kind::Granted || other.What == Kind::Accepted)
        {
            other.What = Kind::Granted;
            other.Since = 0;
        }
    }
    return true;
}

ClaimVotes::Refusal ClaimVotes::LongestRefusal() const
{
    Refusal longest;
    for (const auto &[name, vote] : _votes)
    {
        if (vote.What == Kind::Refused && !vote.Holder.empty())
        {
            longest.Holder = vote.Holder;
            longest.Wait = std::max(longest.Wait, vote.Wait);
        }
    }
    return longest;
}

}  // namespace Rabit
