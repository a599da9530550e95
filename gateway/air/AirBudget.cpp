#include "air/AirBudget.h"

#include <algorithm>
#include <cmath>

namespace Rabit
{
namespace
{

using Duration = AirBudget::Duration;

// What a late driver may catch up.
constexpr Duration CatchUp = std::chrono::milliseconds(10);
// By which what was not scheduled holds up the next datagram of a pace at most, however often it comes.
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

void AirBudget::SetRate(Mode mode, double bytesPerSecond, Duration now)
{
    const double before = _mode == Mode::Unlimited ? 0.0 : Pace();
    _mode = mode;
    _rate = std::max(bytesPerSecond, SmallestRate);
    if (before > 0.0 && _nextAt > now)
    {
        // What is under way takes as long as it does at the new rate; what held it up beside, no longer than
        // anything may.
        const double ratio = before / Pace();
        const Duration held = std::min(_heldUp, _nextAt - now);
        const Duration underWay = Scaled(_nextAt - now - held, ratio);
        _heldUp = std::min(Scaled(held, ratio), LongestHoldUp);
        _nextAt = now + underWay + _heldUp;
    }
}

std::optional<double> AirBudget::Rate() const
{
    return IsUnlimited() ? std::nullopt : std::optional(_rate);
}

double AirBudget::Reserved() const
{
    return _mode == Mode::Budget ? std::min(_reserved, _rate / 2.0) : 0.0;
}

// So that a second, as SlidingSecond has it, is just filled.
double AirBudget::Pace() const
{
    return _mode == Mode::Budget ? (_rate - Reserved()) / Seconds(SlidingSecond::Length) : _rate;
}

Duration AirBudget::TimeOf(std::size_t bytes) const
{
    return Duration(static_cast<Duration::rep>(static_cast<double>(bytes) * 1e9 / Pace()));
}

void AirBudget::Spent(std::size_t bytes, Duration now)
{
    if (_mode == Mode::Budget)
    {
        _second.Add(0, bytes, now);
    }
    else if (_mode == Mode::Pace)
    {
        // Nobody wanted to send for so long: nobody was held up.
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
    if (_mode == Mode::Pace)
    {
        return paced;
    }
    const auto fits = [this, bytes](std::uint64_t scheduled, std::uint64_t unscheduled)
    {
        const double others = std::max(static_cast<double>(unscheduled), Reserved());
        return scheduled == 0 || static_cast<double>(scheduled + bytes) + others <= _rate;
    };
    return std::max(paced, _second.When(fits, now));
}

std::size_t AirBudget::Room(std::size_t most, Duration now)
{
    const auto scheduled = static_cast<double>(_second.Scheduled(now));
    if (_mode != Mode::Budget || scheduled == 0.0)
    {
        return most;
    }
    const double others = std::max(static_cast<double>(_second.Unscheduled(now)), Reserved());
    return static_cast<std::size_t>(std::clamp(_rate - scheduled - others, 0.0, static_cast<double>(most)));
}

void AirBudget::Sent(std::size_t bytes, Duration now)
{
    if (IsUnlimited())
    {
        return;
    }
    _nextAt = std::max(_nextAt, now - CatchUp) + TimeOf(bytes);
    _heldUp = Duration(0);
    if (_mode == Mode::Budget)
    {
        _second.Add(bytes, 0, now);
    }
}

std::size_t AirBudget::LargestDatagram() const
{
    if (IsUnlimited())
    {
        return _largestDatagram;
    }
    double fits = (_rate - Reserved()) * Seconds(LongestDatagram);
    if (_mode == Mode::Pace && fits > static_cast<double>(SmallestDatagram))
    {
        fits = std::sqrt(fits * static_cast<double>(SmallestDatagram));
    }
    if (_mode == Mode::Budget)
    {
        fits = std::max(
            fits, std::min(static_cast<double>(ThriftyDatagram), _rate * Seconds(LongestThriftyDatagram)));
    }
    return std::min(_largestDatagram,
                    std::max(SmallestDatagram, static_cast<std::size_t>(std::min(fits, 1e9))));
}

}  // namespace Rabit
