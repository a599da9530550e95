#include "air/CapacityEstimate.h"

#include <algorithm>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = CapacityEstimate::Duration;

// The delay is kept here, below the target, so that other nodes' datagrams in between do not raise it above
// the target.
constexpr Duration Goal = 40ms;
// A delay above this is a queue of this node; a shorter one comes from other nodes' datagrams.
constexpr Duration Standing = 30ms;
// Seconds in which a queue is emptied. While a longer one is emptied, only the floor is sent.
constexpr double EmptyIn = 0.5;
// With a longer queue buffers may be full.
constexpr Duration ShortEnough = 300ms;
// Two arrivals closer than this say little about a rate.
constexpr Duration ShortestSpan = 300ms;
// Precision of a datagram's sending time. It matters within a burst.
constexpr Duration KnownTo = 20ms;
// A correction's weight.
constexpr double Gain = 0.3;
// Rise in each second, usually and after a quiet time.
constexpr double GentleRise = 0.05;
constexpr double QuickRise = 0.5;
constexpr double CalmRise = 1.0;
constexpr Duration QuietTime = 3s;
// A rate counts as used if at least this share of it is sent, and as unused below the second share.
constexpr double Used = 0.7;
constexpr double Unused = 0.5;
constexpr Duration UnusedTime = 20s;
constexpr int MostDoublings = 3;
// The rate rises by this many bytes a second in each second in any case.
constexpr double Fairness = 200.0;
// Without reports: when the rate begins to fall, and its fall in each second.
constexpr Duration SilentAfter = 3s;
constexpr double FallInSilence = 0.1;
constexpr double LeastInSilence = 0.5;
// Longest time for which beats may have no room for a waiting report.
constexpr Duration NotCrowdedOut = 1s;

double Seconds(Duration time)
{
    return std::chrono::duration<double>(time).count();
}

// The rate that brings a queue to the goal.
double EmptyingRate(double carried, Duration queue)
{
    return carried * (1.0 + Seconds(Goal - queue) / EmptyIn);
}

}  // namespace

// Bytes a second that were carried between two reports' datagrams, as long as there was a queue. Empty if the
// two are too close: the bytes between datagrams sent at once are not known.
std::optional<double> CapacityEstimate::Carried(const DelayReports::Report &from,
                                                const DelayReports::Report &to) const
{
    if (to.ArrivedAt - from.ArrivedAt < ShortestSpan || to.SentAt() - from.SentAt() < 2 * KnownTo)
    {
        return std::nullopt;
    }
    return _sent.Between(from.SentAt(), to.SentAt()) / Seconds(to.ArrivedAt - from.ArrivedAt);
}

// The same if there was no queue at first or for a while, since nothing was sent for longer than it takes to
// empty it. Such a node had nothing to be carried for some of the time. Of datagrams sent at once it is not
// known which one a report is about.
std::optional<double> CapacityEstimate::CarriedOfBurst(const DelayReports::Report &from,
                                                       const DelayReports::Report &to) const
{
    // The bytes between two datagrams of one burst are not known.
    const bool areOfOneBurst = from.Delay > Goal && to.SentAt() - from.SentAt() < 2 * KnownTo;
    if (to.ArrivedAt - from.ArrivedAt < ShortestSpan || areOfOneBurst)
    {
        return std::nullopt;
    }
    const Duration sentAt = to.SentAt() + KnownTo;
    const double all = _sent.Between(from.SentAt(), sentAt) / Seconds(to.ArrivedAt - from.ArrivedAt);
    return from.Delay > Goal && _sent.LongestPause(from.SentAt(), sentAt) <= from.Delay
               ? all
               : std::max(all, _sent.CarriedAtLeast(from.SentAt(), sentAt, to.ArrivedAt));
}

// The least capacity in a peer's reports from before a radio's buffer was full. Datagrams that did not fit
// the buffer were sent and not carried.
std::optional<double> CapacityEstimate::CarriedWhileRising(const DelayReports::Reports &said) const
{
    std::optional<double> least;
    for (std::size_t to = 1; to < said.size(); ++to)
    {
        for (std::size_t from = 0; from < to; ++from)
        {
            const auto carried = CarriedOfBurst(said[from], said[to]);
            if (carried && said[to].Delay > Target && said[to].Delay > said[from].Delay)
            {
                least = std::min(least.value_or(*carried), *carried);
            }
        }
    }
    return least;
}

void CapacityEstimate::Reported(Peer peer, Duration delay, Duration arrivedAt, Duration now)
{
    _reports.Add(peer, delay, arrivedAt, now);
    _wasReported = true;
    const Duration latest = _reports.Latest(now).value_or(Duration(0));
    if (latest > Goal)
    {
        _quietSince = now;
    }
    _agreed = _reports.Agree(Target, now);
    if (_agreed)
    {
        Congested(now);
    }
    if (!_limited)
    {
        return;
    }
    if (latest > Standing)
    {
        Correct(*_reports.Of(peer));
    }
    if (latest > Standing)
    {
        Rise(0.0, now);
    }
    else if (IsUsed(now))
    {
        Rise(now - _quietSince >= QuietTime ? QuickRise : GentleRise, now);
    }
    _carried = std::max(_carried, Floor);
    _reportedAt = now;
    LoosenIfUnused(now);
}

void CapacityEstimate::HeardLate(Duration discovery, Duration all, Duration now)
{
    _discoveryLate = discovery;
    _allLate = all;
    _longWaitSince = all > LongWait ? _longWaitSince : now;
}

std::optional<double> CapacityEstimate::RateWhileHeardLate() const
{
    const bool isLong = _allLate > LongWait && _nothingLateAt < _longWaitSince;
    const bool isUnknown = _discoveryLate > Target && !_wasReported;
    if (!isLong && !isUnknown)
    {
        return std::nullopt;
    }
    return std::max(EmptyingRate(FirstRate, isLong ? _allLate : _discoveryLate), Floor);
}

void CapacityEstimate::NothingLate(Peer peer, Duration sentAt, Duration now)
{
    _nothingLateAt = std::max(_nothingLateAt, sentAt);
    const DelayReports::Reports *const said = _reports.Of(peer);
    if (!_limited || said == nullptr || said->back().Delay > Standing ||
        now - said->back().CameAt < NotCrowdedOut || now - _quietSince < QuietTime)
    {
        return;
    }
    if (IsUsed(now))
    {
        Rise(CalmRise, now);
    }
    _reportedAt = now;
    LoosenIfUnused(now);
}

void CapacityEstimate::Forget()
{
    _reports.Clear();
    _limited = false;
    _agreed = false;
}

void CapacityEstimate::Congested(Duration now)
{
    const auto carried =
        _reports.MedianOf([this](const auto &said) { return CarriedWhileRising(said); }, now);
    const double before = _limited ? _carried : carried.value_or(_sent.Between(now - 1s, now));
    _carried = std::min(before, carried.value_or(before));
    _unusedSince = _limited ? _unusedSince : now;
    _limited = true;
    _doublings = 0;
}

void CapacityEstimate::Correct(const DelayReports::Reports &said)
{
    for (auto from = said.rbegin() + 1; from < said.rend() && from->Delay > Standing; ++from)
    {
        if (const auto carried = Carried(*from, said.back()))
        {
            // Bytes sent into a full buffer are not carried.
            const double most = _carried * (said.back().Delay < ShortEnough ? 1.5 : 1.1);
            _carried += Gain * (std::min(*carried, most) - _carried);
            return;
        }
    }
}

// The rate rises by an equal amount for every node, since the queue reduces rates in proportion. So in the
// end all have the same rate. It also rises by `share` of the rate in each second.
void CapacityEstimate::Rise(double share, Duration now)
{
    const double passed = std::min(Seconds(now - _reportedAt), 1.0);
    _carried += passed * (Fairness + share * _carried);
}

bool CapacityEstimate::IsUsed(Duration now) const
{
    return _sent.Between(now - 1s, now) >= Used * _carried;
}

bool CapacityEstimate::IsUnused(Duration now) const
{
    return now - std::max(_unusedSince, _quietSince) >= UnusedTime &&
           _sent.Between(now - UnusedTime, now) < Unused * _carried * Seconds(UnusedTime);
}

void CapacityEstimate::LoosenIfUnused(Duration now)
{
    if (IsUsed(now))
    {
        _doublings = 0;
    }
    else if (IsUnused(now))
    {
        _carried *= 2.0;
        _unusedSince = now;
        _limited = ++_doublings < MostDoublings;
    }
}

Duration CapacityEstimate::Queue(Duration now) const
{
    // Bytes sent before the reported datagram are carried when it arrives. Bytes sent since then wait, except
    // those carried since then.
    const auto queue = [this, now](const DelayReports::Reports &said)
    {
        const DelayReports::Report &last = said.back();
        const double inFlight = 2.0 * _sent.Between(last.SentAt(), last.ArrivedAt) / _carried;
        const double then = _agreed ? Seconds(last.Delay) : std::min(Seconds(last.Delay), inFlight);
        const double since = _sent.Between(last.ArrivedAt, now) / _carried - Seconds(now - last.ArrivedAt);
        return std::optional(std::max(then + since, 0.0));
    };
    return Duration(static_cast<Duration::rep>(_reports.MedianOf(queue, now).value_or(0.0) * 1e9));
}

std::optional<double> CapacityEstimate::Rate(Duration now) const
{
    if (!_limited)
    {
        return RateWhileHeardLate();
    }
    const double rate = EmptyingRate(_carried, Queue(now));
    const double silence = std::max(Seconds(now - _reportedAt - SilentAfter), 0.0);
    return std::max(rate * std::max(1.0 - FallInSilence * silence, LeastInSilence), Floor);
}

}  // namespace Rabit
