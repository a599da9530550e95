#include "air/AirBudget.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace Rabit
{
namespace
{

using Duration = AirBudget::Duration;

// Longest lateness that a driver may catch up.
constexpr Duration CatchUp = std::chrono::milliseconds(10);
// Longest time by which unscheduled datagrams, however many, hold up the next one with a pace.
constexpr Duration LongestHoldUp = std::chrono::seconds(1);

Duration Scaled(Duration time, double by)
{
    return Duration(static_cast<Duration::rep>(static_cast<double>(time.count()) * by));
}

double Seconds(Duration time)
{
    return std::chrono::duration<double>(time).count();
}

}  // namespace

void AirBudget::SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now)
{
    const auto raised = [](std::optional<double> rate)
    { return rate ? std::optional(std::max(*rate, SmallestRate)) : std::nullopt; };
    const bool wasLimited = !IsUnlimited();
    const double before = wasLimited ? Spacing() : 0.0;
    _budget = raised(budget);
    _pace = raised(pace);
    if (wasLimited && !IsUnlimited() && _nextAt > now)
    {
        // The last datagram takes the time that it needs at the new rate. The hold-up by unscheduled
        // datagrams, with its part that is over, stays within LongestHoldUp.
        const double ratio = before / Spacing();
        const Duration left = std::min(_heldUp, _nextAt - now);
        const Duration over = _heldUp - left;
        const Duration held = std::min(Scaled(left, ratio), LongestHoldUp - over);
        _nextAt = now + Scaled(_nextAt - now - left, ratio) + held;
        _heldUp = over + held;
    }
}

std::optional<double> AirBudget::Rate() const
{
    return _budget && _pace ? std::min(*_budget, *_pace) : _budget ? _budget : _pace;
}

double AirBudget::Reserved() const
{
    return _budget ? std::min(_reserved, *_budget / 2.0) : 0.0;
}

// Bytes a second by which datagrams are spaced. With a budget they just fill a second of SlidingSecond.
double AirBudget::Spacing() const
{
    const double ofBudget = _budget ? (*_budget - Reserved()) / Seconds(SlidingSecond::Length)
                                    : std::numeric_limits<double>::max();
    return std::min(ofBudget, _pace.value_or(ofBudget));
}

Duration AirBudget::TimeOf(std::size_t bytes) const
{
    return Duration(static_cast<Duration::rep>(static_cast<double>(bytes) * 1e9 / Spacing()));
}

void AirBudget::Spent(std::size_t bytes, Duration now)
{
    if (_budget)
    {
        _second.Add(0, bytes, now);
    }
    if (_pace)
    {
        // Nothing wanted to be sent for that time: nothing was held up.
        _heldUp = now - _nextAt > LongestHoldUp ? Duration(0) : _heldUp;
        const Duration more = std::min(TimeOf(bytes), LongestHoldUp - _heldUp);
        _heldUp += more;
        _nextAt = std::max(_nextAt, now) + more;
    }
}

Duration AirBudget::WhenFits(std::size_t bytes, Duration now)
{
    if (IsUnlimited())
    {
        return now;
    }
    const Duration paced = std::max(now, _nextAt);
    if (!_budget)
    {
        return paced;
    }
    const auto fits = [this, bytes](std::uint64_t scheduled, std::uint64_t unscheduled)
    {
        const double others = std::max(static_cast<double>(unscheduled), Reserved());
        return scheduled == 0 || static_cast<double>(scheduled + bytes) + others <= *_budget;
    };
    return std::max(paced, _second.When(fits, now));
}

std::size_t AirBudget::Room(std::size_t most, Duration now)
{
    const auto scheduled = static_cast<double>(_second.Scheduled(now));
    if (!_budget || scheduled == 0.0)
    {
        return most;
    }
    const double others = std::max(static_cast<double>(_second.Unscheduled(now)), Reserved());
    return static_cast<std::size_t>(
        std::clamp(*_budget - scheduled - others, 0.0, static_cast<double>(most)));
}

void AirBudget::Sent(std::size_t bytes, Duration now)
{
    if (IsUnlimited())
    {
        return;
    }
    _nextAt = std::max(_nextAt, now - CatchUp) + TimeOf(bytes);
    _heldUp = Duration(0);
    if (_budget)
    {
        _second.Add(bytes, 0, now);
    }
}

std::size_t AirBudget::LargestDatagram() const
{
    double fits = static_cast<double>(_largestDatagram);
    if (_budget)
    {
        const double thrifty =
            std::min(static_cast<double>(ThriftyDatagram), *_budget * Seconds(LongestThriftyDatagram));
        fits = std::min(fits, std::max((*_budget - Reserved()) * Seconds(LongestDatagram), thrifty));
    }
    if (_pace)
    {
        const double ofPace = *_pace * Seconds(LongestDatagram);
        const auto least = static_cast<double>(SmallestDatagram);
        fits = std::min(fits, ofPace > least ? std::sqrt(ofPace * least) : ofPace);
    }
    return std::min(_largestDatagram, std::max(SmallestDatagram, static_cast<std::size_t>(fits)));
}

}  // namespace Rabit
