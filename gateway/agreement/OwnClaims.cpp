#include "agreement/OwnClaims.h"

#include <algorithm>

namespace Rabit
{

OwnClaims::OwnClaims(const AgreementSettings &settings, std::function<std::uint64_t()> random)
    : _settings(settings), _random(std::move(random)), _lease(settings)
{
    for (const std::string &member : settings.Members)
    {
        _retries.emplace(member, BackoffTimer<Duration>({FirstRetry, settings.Lease / 2}));
    }
}

bool OwnClaims::Want(const std::string &claim, bool keeps, Duration now)
{
    if (claim.empty() || claim.size() > AgreementSettings::LongestName)
    {
        return false;
    }
    const auto known = _claims.find(claim);
    if (known == _claims.end())
    {
        if (_claims.size() >= AgreementSettings::MostClaims)
        {
            JudgeAll(now);  // some may have been given up meanwhile
        }
        if (_claims.size() >= AgreementSettings::MostClaims)
        {
            return false;
        }
        Claim wanted{.Votes = ClaimVotes(claim, _settings.Members), .Keeps = keeps};
        Begin(_claims.emplace(claim, std::move(wanted)).first->second, now);
        return true;
    }
    const bool wasGivenUp = known->second.Now == Phase::Releasing && !known->second.Keeps;
    known->second.Keeps = known->second.Keeps || keeps;
    if (wasGivenUp)
    {
        Begin(known->second, now);
    }
    return true;
}

void OwnClaims::GiveUp(const std::string &claim, Duration now)
{
    const auto known = _claims.find(claim);
    if (known == _claims.end())
    {
        return;
    }
    known->second.Keeps = false;
    if (known->second.Now != Phase::Releasing)
    {
        Release(known->second, now);
    }
}

bool OwnClaims::IsWanted(std::string_view claim) const
{
    const auto known = _claims.find(claim);
    return known != _claims.end() && IsWanted(known->second);
}

std::vector<std::string> OwnClaims::Kept() const
{
    std::vector<std::string> kept;
    for (const auto &[name, claim] : _claims)
    {
        if (claim.Keeps)
        {
            kept.push_back(name);
        }
    }
    return kept;
}

bool OwnClaims::Lacks(Duration now) const
{
    return std::any_of(_claims.begin(), _claims.end(),
                       [this, now](const auto &claim)
                       { return IsWanted(claim.second) && !FenceOf(claim.first, now); });
}

std::optional<std::uint64_t> OwnClaims::FenceOf(std::string_view claim, Duration now) const
{
    const auto known = _claims.find(claim);
    const bool isHeld =
        known != _claims.end() && known->second.Now == Phase::Held && now < HeldUntil(known->second);
    return isHeld ? std::optional(known->second.Votes.Fence()) : std::nullopt;
}

std::vector<std::string> OwnClaims::Held(Duration now) const
{
    std::vector<std::string> held;
    for (const auto &[name, claim] : _claims)
    {
        if (FenceOf(name, now))
        {
            held.push_back(name);
        }
    }
    return held;
}

void OwnClaims::ClockStoodStill(Duration now)
{
    for (const auto &[name, claim] : _claims)
    {
        if (claim.Now == Phase::Held)
        {
            _events.push_back({Event::Kind::Lost, name, claim.Votes.Fence()});
        }
    }
    EndSession();
    std::erase_if(_claims, [](const auto &claim) { return !claim.second.Keeps; });
    for (auto &[name, claim] : _claims)
    {
        Begin(claim, now);
    }
}

// The voters' books of the former session end by themselves.
void OwnClaims::EndSession()
{
    _lease.EndSession();
    _leftGrants = false;
    for (auto &[name, claim] : _claims)
    {
        claim.Votes.ForgetAll();
    }
}

// New orders go at once, and so does a renewal if there was none.
void OwnClaims::Hurry(Duration now)
{
    for (auto &[voter, retry] : _retries)
    {
        retry.Begin(now);
    }
    if (Renews())
    {
        _lease.Begin(now);
    }
}

void OwnClaims::Enter(Claim &claim, Phase phase, Duration now)
{
    claim.Now = phase;
    claim.Since = now;
    Hurry(now);
}

void OwnClaims::Begin(Claim &claim, Duration now)
{
    claim.Votes.Ask();
    claim.Refused = false;
    claim.Patience = Apart + RandomPart();
    claim.AskAgainAt = now + Apart / 2;
    Enter(claim, Phase::Asking, now);
}

void OwnClaims::Release(Claim &claim, Duration now)
{
    claim.Votes.Release();
    Enter(claim, Phase::Releasing, now);
}

void OwnClaims::GiveWay(Claim &claim, Duration wait, Duration now)
{
    Release(claim, now);
    claim.RetryAt = now + wait + RandomPart();
}

OwnClaims::Duration OwnClaims::RandomPart()
{
    return Duration(static_cast<std::int64_t>(_random() % static_cast<std::uint64_t>(Apart.count())));
}

OwnClaims::Duration OwnClaims::HeldUntil(const Claim &claim) const
{
    return _lease.UntilOf(claim.Votes.VotersThat(ClaimVotes::Kind::Accepted));
}

// When the voters that did not answer a Release are taken for gone. An answer of theirs moves that.
OwnClaims::Duration OwnClaims::InVainFrom(const Claim &claim) const
{
    Duration from = claim.Since;
    for (const std::string_view voter : claim.Votes.VotersThatWereAsked())
    {
        from = std::max({from, claim.Since + _settings.VotersLease(), _lease.UntilOf(voter)});
    }
    return from;
}

// If voters are silent, a claimant that was refused by others waits the longer the more have granted.
OwnClaims::Duration OwnClaims::PatienceOf(const Claim &claim) const
{
    const auto granted = static_cast<std::int64_t>(claim.Votes.Count(ClaimVotes::Kind::Granted));
    return claim.Refused ? std::min(claim.Patience + granted * Apart, _settings.Lease) : _settings.Lease;
}

bool OwnClaims::Renews() const
{
    return std::any_of(_claims.begin(), _claims.end(),
                       [](const auto &claim) {
                           return claim.second.Now != Phase::Releasing && claim.second.Now != Phase::Waiting;
                       });
}

bool OwnClaims::HasOrders(std::string_view voter) const
{
    return _lease.KnowsBookOf(voter) &&
           std::any_of(_claims.begin(), _claims.end(),
                       [voter](const auto &claim) { return claim.second.Votes.OrderTo(voter).has_value(); });
}

void OwnClaims::Judge(const std::string &name, Claim &claim, Duration now)
{
    switch (claim.Now)
    {
        case Phase::Waiting:
            if (now >= claim.RetryAt)
            {
                Begin(claim, now);
            }
            break;
        case Phase::Asking:
            JudgeAsked(name, claim, now);
            break;
        case Phase::Accepting:
            if (HeldUntil(claim) > now)
            {
                claim.Votes.Hold();
                claim.Now = Phase::Held;
                claim.Since = now;
                _events.push_back({Event::Kind::Gained, name, claim.Votes.Fence()});
            }
            else if (now - claim.Since > _settings.Lease)
            {
                // The voters that granted are gone.
                _events.push_back({Event::Kind::NoMajority, name});
                GiveWay(claim, Duration(0), now);
            }
            break;
        case Phase::Held:
            if (now >= HeldUntil(claim))
            {
                _events.push_back({Event::Kind::Lost, name, claim.Votes.Fence()});
                GiveWay(claim, Duration(0), now);
            }
            else if (now - claim.Since >= _settings.Lease && claim.Votes.Count(ClaimVotes::Kind::Refused) > 0)
            {
                // The more voters keep a claim, the more may fail.
                claim.Votes.AskRefusedAgain();
                Enter(claim, Phase::Held, now);
            }
            break;
        case Phase::Releasing:
            JudgeReleased(claim, now);
            break;
    }
}

void OwnClaims::JudgeAsked(const std::string &name, Claim &claim, Duration now)
{
    if (claim.Votes.Count(ClaimVotes::Kind::Granted) >= _settings.Majority())
    {
        claim.Votes.Accept();
        Enter(claim, Phase::Accepting, now);
        return;
    }
    const std::size_t refusals = claim.Votes.Count(ClaimVotes::Kind::Refused);
    claim.Refused = claim.Refused || refusals > 0;
    const bool mayWin = _settings.Members.size() - refusals >= _settings.Majority();
    if (mayWin && now - claim.Since <= PatienceOf(claim))
    {
        if (now >= claim.AskAgainAt)
        {
            claim.Votes.AskRefusedAgain();
            claim.AskAgainAt = now + Apart / 2;
            Hurry(now);
        }
        return;
    }
    ClaimVotes::Refusal refusal = claim.Votes.LongestRefusal();
    // If some voters are silent, the others may be split. Then the votes of the one that gives way first are
    // for the others.
    GiveWay(claim, mayWin ? std::max<Duration>(refusal.Wait, Apart) : refusal.Wait, now);
    _events.push_back(
        {claim.Refused ? Event::Kind::Refused : Event::Kind::NoMajority, name, 0, std::move(refusal.Holder)});
}

void OwnClaims::JudgeReleased(Claim &claim, Duration now)
{
    if (claim.Keeps && now >= claim.RetryAt)
    {
        Begin(claim, now);
        return;
    }
    if (now >= InVainFrom(claim))
    {
        _leftGrants = _leftGrants || !claim.Votes.VotersThatWereAsked().empty();
        claim.Votes.ForgetAll();
    }
    if (claim.Keeps && claim.Votes.VotersThatWereAsked().empty())
    {
        claim.Now = Phase::Waiting;
    }
}

void OwnClaims::JudgeAll(Duration now)
{
    for (auto &[name, claim] : _claims)
    {
        Judge(name, claim, now);
    }
    std::erase_if(_claims,
                  [](const auto &claim)
                  {
                      return claim.second.Now == Phase::Releasing && !claim.second.Keeps &&
                             claim.second.Votes.VotersThatWereAsked().empty();
                  });
    if (Renews())
    {
        return;
    }
    _lease.Pause();
    const bool releases = std::any_of(_claims.begin(), _claims.end(),
                                      [](const auto &claim) { return claim.second.Now == Phase::Releasing; });
    if (_leftGrants && !releases)
    {
        EndSession();
    }
}

void OwnClaims::OnReply(std::string_view from, const ClaimReply &reply, Duration now)
{
    // A claim whose lease has passed is lost, whatever the reply says.
    JudgeAll(now);
    const auto retry = _retries.find(from);
    const ClaimLease::Answer answer = _lease.Take(from, reply, now);
    if (answer == ClaimLease::Answer::Ignored || retry == _retries.end())
    {
        return;
    }
    if (answer == ClaimLease::Answer::OfNewBook)
    {
        for (auto &[name, claim] : _claims)
        {
            claim.Votes.ForgetBookOf(from);
        }
        retry->second.Begin(now);
    }
    for (const ClaimResult &result : reply.Results)
    {
        const auto claim = _claims.find(result.Name);
        if (claim != _claims.end() && claim->second.Votes.Take(from, reply.Number, reply.Fences, result))
        {
            Hurry(now);
        }
    }
    if (!reply.Results.empty() && HasOrders(from))
    {
        retry->second.Begin(now);
    }
    JudgeAll(now);
}

std::optional<OwnClaims::Duration> OwnClaims::Due() const
{
    std::optional<Duration> due = Renews() ? _lease.RenewAt() : std::nullopt;
    const auto by = [&due](Duration at) { due = due ? std::min(*due, at) : at; };
    for (const auto &[voter, retry] : _retries)
    {
        if (retry.Due() && HasOrders(voter))
        {
            by(*retry.Due());
        }
    }
    for (const auto &[name, claim] : _claims)
    {
        switch (claim.Now)
        {
            case Phase::Waiting:
                by(claim.RetryAt);
                break;
            case Phase::Held:
                by(HeldUntil(claim));
                if (claim.Votes.Count(ClaimVotes::Kind::Refused) > 0)
                {
                    by(claim.Since + _settings.Lease);
                }
                break;
            case Phase::Releasing:
                by(claim.Keeps ? std::min(claim.RetryAt, InVainFrom(claim)) : InVainFrom(claim));
                break;
            case Phase::Asking:
                by(claim.Since + PatienceOf(claim) + std::chrono::nanoseconds(1));
                if (claim.Votes.Count(ClaimVotes::Kind::Refused) > 0)
                {
                    by(claim.AskAgainAt);
                }
                break;
            case Phase::Accepting:
                by(claim.Since + _settings.Lease + std::chrono::nanoseconds(1));
                break;
        }
    }
    return due;
}

std::optional<OwnClaims::Outgoing> OwnClaims::TakeDue(Duration now)
{
    JudgeAll(now);
    for (auto &[voter, retry] : _retries)
    {
        if (!retry.IsDue(now) || !_lease.KnowsBookOf(voter))
        {
            continue;
        }
        if (HasOrders(voter))
        {
            retry.Done(now);
            return Outgoing{.To = voter, .Request = OrdersTo(voter, Orders::All, now)};
        }
        retry.Stop();
    }
    if (Renews() && _lease.RenewAt() && *_lease.RenewAt() <= now)
    {
        return Outgoing{.To = "", .Request = _lease.Renew(now)};
    }
    return std::nullopt;
}

std::optional<ClaimRequest> OwnClaims::RenewByBeat(Duration now)
{
    return Renews() ? std::optional(_lease.RenewByBeat(now)) : std::nullopt;
}

std::vector<OwnClaims::Outgoing> OwnClaims::Leave(Duration now)
{
    for (auto &[name, claim] : _claims)
    {
        claim.Keeps = false;
        Release(claim, now);
    }
    std::vector<Outgoing> last;
    for (const auto &[voter, retry] : _retries)
    {
        const auto isUnsent = [&to = voter](const auto &claim) { return claim.second.Votes.IsUnsent(to); };
        while (_lease.KnowsBookOf(voter) && std::any_of(_claims.begin(), _claims.end(), isUnsent))
        {
            last.push_back({.To = voter, .Request = OrdersTo(voter, Orders::Unsent, now)});
        }
    }
    return last;
}

ClaimRequest OwnClaims::OrdersTo(const std::string &voter, Orders which, Duration now)
{
    ClaimRequest request = _lease.OrdersTo(voter, now);
    for (auto &[name, claim] : _claims)
    {
        const auto order =
            which == Orders::All || claim.Votes.IsUnsent(voter) ? claim.Votes.OrderTo(voter) : std::nullopt;
        if (order && request.Orders.size() < ClaimRequest::MostOrders)
        {
            claim.Votes.Sent(voter, request.Number);
            request.Orders.push_back(*order);
        }
    }
    return request;
}

}  // namespace Rabit
