#include "agreement/ClaimLease.h"

#include <algorithm>
#include <utility>

namespace Rabit
{
namespace
{

// Renewals in a lease. If half of a lease was not acknowledged, they follow four times as fast, for a lease.
// Then there is no majority in reach, and they grow rarer.
constexpr int RenewalsInALease = 4;
constexpr int HastyRenewalsInALease = 16;
// With renewals in beats, of which four come in a lease, an answer comes up to a beat later than in a
// datagram. So up to half of a lease passes between an acknowledged renewal and the answer to the next one.
constexpr int SixteenthsLeftWithBeats = 7;
// Bounds the memory for times of renewals. 64 voters with a request each 100 ms make 1,300 in a lease of 2 s,
// and 64 claims that are asked for and accepted, 4 in a request, 2,048 more.
constexpr std::size_t RememberedRenewals = 4096;

}  // namespace

ClaimLease::ClaimLease(const AgreementSettings &settings)
    : _settings(settings),
      _group(settings.Group()),
      _hasty(Backoff::Settings{.First = settings.Lease / HastyRenewalsInALease,
                               .Longest = settings.Lease,
                               .QuickSteps = HastyRenewalsInALease,
                               .Quick = settings.Lease / HastyRenewalsInALease})
{
    for (const std::string &member : settings.Members)
    {
        _voters.emplace(member, Voter());
    }
}

void ClaimLease::Begin(Duration now)
{
    _renewAt = _renewAt.value_or(now);
}

ClaimRequest ClaimLease::Renew(Duration now)
{
    _ridesInBeats = false;
    _renewAt = now + (IsLate(now) ? _hasty.Next() : _settings.Lease / RenewalsInALease);
    return NewRequest(now);
}

ClaimRequest ClaimLease::RenewByBeat(Duration now)
{
    _ridesInBeats = true;
    _renewAt = IsLate(now) ? _renewAt.value_or(now) : LateAfter();
    return NewRequest(now);
}

ClaimLease::Duration ClaimLease::LateAfter() const
{
    std::vector<Duration> ends;
    for (const auto &[name, voter] : _voters)
    {
        ends.push_back(voter.Until);
    }
    const Duration left =
        _ridesInBeats ? _settings.Lease * SixteenthsLeftWithBeats / 16 : _settings.Lease / 2;
    return OfMajority(std::move(ends)) - left;
}

ClaimRequest ClaimLease::OrdersTo(std::string_view voter, Duration now)
{
    ClaimRequest request = NewRequest(now);
    request.Book = Of(voter).Book;
    request.Number = ++_number;
    return request;
}

ClaimRequest ClaimLease::NewRequest(Duration now)
{
    // An older renewal makes no lease longer.
    while (!_sent.empty() && (_sent.front() + _settings.Lease <= now || _sent.size() >= RememberedRenewals))
    {
        _sent.pop_front();
    }
    _sent.push_back(now);
    return {
        .Group = _group, .Incarnation = _settings.Incarnation, .Session = _session, .Renewal = ++_renewal};
}

ClaimLease::Answer ClaimLease::Take(std::string_view from, const ClaimReply &reply, Duration now)
{
    const auto found = _voters.find(from);
    if (found == _voters.end() || reply.Group != _group || reply.Claimant != _settings.Incarnation ||
        reply.Session != _session || reply.Book == 0)
    {
        return Answer::Ignored;
    }
    Voter &voter = found->second;
    const std::pair told(reply.Incarnation, reply.Book);
    const std::pair known(voter.Incarnation, voter.Book);
    if (told < known && now < voter.Until)
    {
        return Answer::Ignored;
    }
    if (told != known)
    {
        voter = {.Incarnation = reply.Incarnation, .Book = reply.Book};
    }
    const std::uint32_t forgotten = _renewal - static_cast<std::uint32_t>(_sent.size());
    if (reply.Renewal > forgotten && reply.Renewal <= _renewal)
    {
        voter.Until = std::max(voter.Until, _sent[reply.Renewal - forgotten - 1] + _settings.Lease);
    }
    if (!IsLate(now))
    {
        _hasty.Reset();
        if (_renewAt)
        {
            // The next renewal may be a whole lease away, and this one ends before it.
            _renewAt =
                _ridesInBeats ? LateAfter() : std::min(*_renewAt, now + _settings.Lease / RenewalsInALease);
        }
    }
    return told == known ? Answer::OfKnownBook : Answer::OfNewBook;
}

ClaimLease::Duration ClaimLease::UntilOf(const std::vector<std::string_view> &voters) const
{
    std::vector<Duration> ends;
    for (const std::string_view voter : voters)
    {
        ends.push_back(UntilOf(voter));
    }
    return OfMajority(std::move(ends));
}

ClaimLease::Duration ClaimLease::OfMajority(std::vector<Duration> ends) const
{
    std::sort(ends.rbegin(), ends.rend());
    return ends.size() < _settings.Majority() ? Duration(0) : ends[_settings.Majority() - 1];
}

void ClaimLease::EndSession()
{
    ++_session;
    _renewal = 0;
    _number = 0;
    _sent.clear();
    _renewAt.reset();
    for (auto &[name, voter] : _voters)
    {
        voter.Book = 0;
        voter.Until = Duration(0);
    }
}

}  // namespace Rabit
