#include "PathControl.h"

#include <algorithm>
#include <cmath>

namespace Rabit
{

namespace
{

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

// Round trips up to this are those of wires. There nothing is paced: timers are too coarse.
constexpr LinkTime ShortRoundTrip = 10ms;
constexpr LinkTime PacedFrom = 5ms;
// Losses on a short path do not reduce its window below this many datagrams.
constexpr std::size_t LeastOnWire = 8;
// How long the shortest round trip may take to be measured.
constexpr LinkTime LongestDrain = 2s;
// An acknowledgement is requested after DatagramsToAsk datagrams, or after the window divided by PartToAsk,
// if that is more.
constexpr std::size_t DatagramsToAsk = 3;
constexpr std::size_t PartToAsk = 4;
constexpr LinkTime LongestDatagramTime = 250ms;
// The window grows to at most this multiple of the bytes that arrive in the target round trip (BBR).
constexpr double UsefulWindow = 2.0;
constexpr double SlowStartPace = 2.0;
constexpr double PaceGain = 1.25;
constexpr double MostLossToPace = 0.75;
// A pace is used up if at least this share of it was sent.
constexpr double UsedPace = 0.8;
// Slow start ends when something was lost and the delivery rate has not grown by the factor Growth for
// StalledRounds round trips.
constexpr double Growth = 1.25;
constexpr int StalledRounds = 2;

std::size_t Scaled(std::size_t bytes, double factor)
{
    return static_cast<std::size_t>(static_cast<double>(bytes) * factor);
}

}  // namespace

PathControl::PathControl(const LinkSettings &settings, std::size_t &starting)
    : _settings(settings),
      _datagram(settings.MaxDatagram + settings.AirOverhead),
      _starting(starting),
      _window(FirstWindow())
{
}

// To be called after each change of the window or of slow start.
void PathControl::LookIfStarts()
{
    const bool starts = _slowStart && _window <= FirstWindow();
    if (starts != _starts)
    {
        _starts = starts;
        _starting += starts ? _inFlight : -_inFlight;
    }
}

// While the shortest round trip is measured there is one datagram at a time.
std::size_t PathControl::Window() const
{
    return _draining ? 1 : _window;
}

bool PathControl::HasRoom() const
{
    return _inFlight == 0 || (_inFlight + Datagram() / 2 < Window() &&
                              (!_starts || _starting + Datagram() / 2 < FirstWindow()));
}

bool PathControl::TakeAsk(LinkTime now)
{
    const bool asked = _askedAt > _echoed;
    if (_sinceAsked < std::max(DatagramsToAsk * Datagram(), Window() / PartToAsk) && (HasRoom() || asked))
    {
        return false;
    }
    _sinceAsked = 0;
    _askedAt = AsEchoed(now);
    return true;
}

bool PathControl::IsShort() const
{
    return _shortest > LinkTime(0) && _shortest <= ShortRoundTrip && _times.Smoothed() <= 2 * ShortRoundTrip;
}

void PathControl::Sent(std::size_t bytes, LinkTime now)
{
    if (_inFlight == 0 && _starts)
    {
        _window = FirstWindow() - std::min(_starting, FirstWindow() - Datagram());
    }
    Enter(bytes);
    _sinceAsked += bytes;
    _wasFull = _wasFull || _inFlight + Datagram() >= Window();
    if (_times.Smoothed() < PacedFrom || _draining)
    {
        return;
    }
    _roundSent += bytes;
    const double rate = Pace();
    const auto timeOf = [rate](std::size_t size)
    { return std::chrono::duration_cast<LinkTime>(Seconds(static_cast<double>(size) / rate)); };
    _pacedUntil = std::max(_pacedUntil, now - timeOf(Datagram())) + timeOf(bytes);
}

// A quarter faster than the window per round trip, so that the window is the limit. But no faster than the
// delivery rate justifies: bursts overflow the buffers in front of a slow medium and leave them empty in
// between, so that no round trip shows it.
double PathControl::Pace() const
{
    const double roundTrip = Seconds(_times.Smoothed()).count();
    const double byWindow =
        (_slowStart ? SlowStartPace : PaceGain) * static_cast<double>(_window) / roundTrip;
    if (_slowStart || _rate <= 0)
    {
        return byWindow;
    }
    const double byRate = PaceGain * _rate / (1 - std::min(_lossRate, MostLossToPace));
    return std::min(byWindow, std::max(byRate, static_cast<double>(FirstWindow()) / roundTrip));
}

void PathControl::Acknowledged(std::size_t bytes, LinkTime now)
{
    Leave(bytes);
    _roundAcknowledged += bytes;
    _lossRate -= _lossRate * WeightOf(bytes);
    if (_draining && _drainedAt == LinkNever && _inFlight == 0)
    {
        _drainedAt = now;
    }
}

void PathControl::Lost(std::size_t bytes)
{
    Leave(bytes);
    _roundLost += bytes;
    _lossRate += (1 - _lossRate) * WeightOf(bytes);
}

// Weight of `bytes` bytes in an average over some tens of datagrams.
double PathControl::WeightOf(std::size_t bytes) const
{
    const double datagrams = static_cast<double>(bytes) / static_cast<double>(Datagram());
    return datagrams / (32 + datagrams);
}

void PathControl::Measured(LinkTime roundTrip, LinkTime sentAt, LinkTime now)
{
    _times.Measured(roundTrip);
    _echoed = std::max(_echoed, sentAt);
    if (_shortest == LinkTime(0) || roundTrip <= _shortest + _shortest / 16)
    {
        _shortest = _shortest == LinkTime(0) ? std::max(roundTrip, LinkTime(1))
                                             : std::clamp(roundTrip, LinkTime(1), _shortest);
        _shortestAt = now;
        _draining = false;
    }
    else if (_draining &&
             ((_drainedAt != LinkNever && sentAt >= _drainedAt) || now - _drainStart > LongestDrain))
    {
        _shortest = std::min(roundTrip, _roundShortest);
        _shortestAt = now;
        _draining = false;
    }
    _roundShortest = std::min(_roundShortest, roundTrip);
    if (sentAt >= _roundStart)
    {
        EndRound(now);
    }
}

void PathControl::EndRound(LinkTime now)
{
    RememberShortest(_roundShortest, now);
    _queueingDelay = std::max(_roundShortest - _shortest, LinkTime(0));
    const Seconds duration = now - _roundStart;
    if (_roundStart > LinkTime(0) && duration.count() > 0)
    {
        const double rate = static_cast<double>(_roundAcknowledged) / duration.count();
        LookForEndOfSlowStart(rate);
        // The last few rounds count: the newest most, the best of them if it is falling.
        const bool wasUsed =
            _wasFull || static_cast<double>(_roundSent) >= UsedPace * Pace() * duration.count();
        _rate = std::max(rate, wasUsed ? _rate * 0.75 : _rate);
    }
    if (!_draining)
    {
        Decide(_roundShortest);
    }
    LookIfStarts();
    _roundStart = now;
    _roundShortest = LinkNever;
    _roundAcknowledged = 0;
    _roundLost = 0;
    _roundSent = 0;
    _wasFull = _inFlight + Datagram() >= Window();
}

// Data is lost, and the delivery rate no longer grows (BBR's full pipe).
void PathControl::LookForEndOfSlowStart(double rate)
{
    if (!_slowStart || _roundAcknowledged + _roundLost < FirstWindow())
    {
        return;
    }
    _stalled = _roundLost > 0 && rate < Growth * _rate ? _stalled + 1 : 0;
    _slowStart = _stalled < StalledRounds;
}

// Without a full window nothing of this node waits in buffers, so the measured round trip is that of the
// path.
void PathControl::RememberShortest(LinkTime roundTrip, LinkTime now)
{
    if (_draining || now - _shortestAt < _settings.PathMemory)
    {
        return;
    }
    if (!_wasFull)
    {
        _shortest = roundTrip;
        _shortestAt = now;
        return;
    }
    _draining = true;
    _drainStart = now;
    _drainedAt = _inFlight == 0 ? now : LinkNever;
}

LinkTime PathControl::Target() const
{
    const double datagramTime = _rate > 0 ? static_cast<double>(Datagram()) / _rate : 0;
    const LinkTime one =
        std::min(std::chrono::duration_cast<LinkTime>(Seconds(datagramTime)), LongestDatagramTime);
    const double patience = std::max(0.3, 1 - 2 * _lossRate);
    return one + std::chrono::duration_cast<LinkTime>(patience * Seconds(_settings.QueueingTarget));
}

void PathControl::Decide(LinkTime roundTrip)
{
    const LinkTime target = Target();
    const std::size_t all = _roundAcknowledged + _roundLost;
    if (_queueingDelay > target)
    {
        const double factor = Seconds(_shortest + target * 3 / 4) / Seconds(roundTrip);
        _window = Scaled(_window, std::clamp(factor, 0.3, 1.0));
        _slowStart = false;
    }
    else if (_roundLost > 0 && IsShort() && _window > LeastOnWire * Datagram())
    {
        _window = std::max(Scaled(_window, 0.7), LeastOnWire * Datagram());
        _slowStart = false;
    }
    else if (_roundLost * 5 > all * 4 && all >= 4 * Datagram())
    {
        _window = Scaled(_window, 0.7);
        _slowStart = false;
    }
    else if (_wasFull)
    {
        if (_slowStart && _queueingDelay > target / 2)
        {
            _slowStart = false;
        }
        const bool empty = _queueingDelay <= target / 4;
        const double factor = std::min(Seconds(_shortest + target) / Seconds(roundTrip), 1.25);
        const std::size_t more = _slowStart ? _roundAcknowledged
                                 : empty    ? _window / 4
                                            : Scaled(_window, std::max(factor, 1.0) - 1) / 2;
        _window += std::max<std::size_t>(more, 1);
        // Bytes under way that were sent in bursts leave the buffer empty in between, however many they are.
        if (!_slowStart && _rate > 0)
        {
            const double useful = UsefulWindow * _rate * Seconds(_shortest + target).count();
            _window = std::min(_window, std::max(static_cast<std::size_t>(useful), FirstWindow()));
        }
    }
    _window = std::clamp(_window, Datagram(), std::max(_settings.LargestWindow, FirstWindow()));
}

void PathControl::Restart()
{
    _window = std::min(_window, FirstWindow());
    _slowStart = true;
    LookIfStarts();
    _draining = false;
    _pacedUntil = LinkTime(0);
    _rate = 0;
    _stalled = 0;
}

void PathControl::Replace()
{
    Restart();
    _answered = 0;
    _usualAnswer = LinkTime(0);
    _times = RoundTrip();
    _shortest = LinkTime(0);
    _queueingDelay = LinkTime(0);
    _roundShortest = LinkNever;
    _lossRate = 0;
}

}  // namespace Rabit
