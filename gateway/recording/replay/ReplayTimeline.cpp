#include "recording/replay/ReplayTimeline.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace Rabit::Replay
{
namespace
{

// Longest time between two recorded messages: about 47 years.
constexpr Time Longest = 1'500'000'000'000'000'000;

ReplayTimeline::Duration Between(Time from, Time to)
{
    return ReplayTimeline::Duration(to > from ? static_cast<std::int64_t>(std::min(to - from, Longest)) : 0);
}

Time EndOfRound(const ReplayTimeline::Settings &settings)
{
    const bool isTooShort = settings.Loops && settings.To < settings.From + ReplayTimeline::ShortestRound;
    return isTooShort ? settings.From + ReplayTimeline::ShortestRound : settings.To;
}

}  // namespace

ReplayTimeline::ReplayTimeline(ReplaySource &source, const Settings &settings, Duration now)
    : _source(source), _settings(settings), _roundEnd(EndOfRound(settings)), _paused(settings.Paused)
{
    Jump(_settings.From, now);
}

void ReplayTimeline::Jump(Time to, Duration now)
{
    const std::vector<ReplayItem> before = _source.LastBefore(to);
    _restored.assign(before.begin(), before.end());
    _source.Begin(to);
    _jumpedTo = to;
    _anchor = to;
    _anchorNow = now;
    _steps = 0;
    _anyInRound = false;
    ++_jumps;
    TakeNext();
}

void ReplayTimeline::TakeNext()
{
    _next = _source.Next();
    if (_next && _next->LogTime > _settings.To)
    {
        _next.reset();
    }
}

std::optional<ReplayTimeline::Due> ReplayTimeline::Next(Duration now)
{
    if (!_restored.empty())
    {
        Due due{std::move(_restored.front()), Duration(0), true};
        due.Age = Between(due.Item.PublishTime, _jumpedTo);
        _restored.pop_front();
        return due;
    }
    if (!_next && IsRoundOver(now) && _settings.Loops && _anyInRound)
    {
        ++_rounds;
        Jump(_settings.From, now);
        return Next(now);
    }
    if (!_next || (_steps == 0 && !IsTurnOf(_next->LogTime, now)))
    {
        return std::nullopt;
    }
    if (_steps > 0 || _settings.Rate == 0.0)
    {
        _steps -= _steps > 0 ? 1 : 0;
        _anchor = std::max(_anchor, _next->LogTime);
        _anchorNow = now;
    }
    Due due{std::move(*_next), Duration(0), false};
    due.Age = Between(due.Item.PublishTime, due.Item.LogTime);
    _anyInRound = true;
    TakeNext();
    return due;
}

bool ReplayTimeline::IsTurnOf(Time time, Duration now) const
{
    return !_paused && (_settings.Rate == 0.0 || now >= When(time));
}

// Returns when that moment of the recording is due, by the caller's clock, unless the replay is paused.
ReplayTimeline::Duration ReplayTimeline::When(Time time) const
{
    constexpr double never = 4e18;
    const double wait = static_cast<double>(Between(_anchor, time).count()) / _settings.Rate;
    return _anchorNow + Duration(static_cast<std::int64_t>(std::min(wait, never)));
}

std::optional<ReplayTimeline::Duration> ReplayTimeline::DueAt(Duration now) const
{
    if (!_restored.empty() || (_next && _steps > 0))
    {
        return now;
    }
    if (_paused || IsAtEnd(now))
    {
        return std::nullopt;
    }
    return _settings.Rate == 0.0 ? now : std::max(now, When(_next ? _next->LogTime : _roundEnd));
}

void ReplayTimeline::Pause(Duration now)
{
    if (!_paused)
    {
        _anchor = Position(now);
        _anchorNow = now;
        _paused = true;
    }
}

void ReplayTimeline::Resume(Duration now)
{
    if (_paused)
    {
        _anchorNow = now;
        _paused = false;
        _steps = 0;
    }
}

void ReplayTimeline::Step(Duration now)
{
    Pause(now);
    ++_steps;
}

void ReplayTimeline::Seek(Time to, Duration now)
{
    Jump(std::clamp(to, _settings.From, std::max(_settings.From, _settings.To)), now);
}

Time ReplayTimeline::Position(Duration now) const
{
    if (_paused || _settings.Rate == 0.0)
    {
        return _anchor;
    }
    const double passed = static_cast<double>(std::max(Duration(0), now - _anchorNow).count());
    const Time position = _anchor + static_cast<Time>(passed * _settings.Rate);
    return std::min(position, std::max(_anchor, _roundEnd));
}

bool ReplayTimeline::IsRoundOver(Duration now) const
{
    return !_next && !_paused && (_settings.Rate == 0.0 || now >= When(_roundEnd));
}

bool ReplayTimeline::IsAtEnd(Duration now) const
{
    return _restored.empty() && IsRoundOver(now) && !(_settings.Loops && _anyInRound);
}

}  // namespace Rabit::Replay
