#include "Playing.h"

#include <rabit/RabitClock.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "CommonOptions.h"
#include "FleetSession.h"
#include "Output.h"
#include "Table.h"

namespace Rabit::Tool
{

using Replay::ReplayTimeline;

namespace
{

std::chrono::nanoseconds Now()
{
    return RabitClock::System()->Monotonic();
}

std::string SecondsText(Replay::Time from, Replay::Time to)
{
    return NumberText(1e-9 * static_cast<double>(to - from), 1, " s");
}

}  // namespace

Playing::Playing(PlayedFiles &files, const ReplayTimeline::Settings &settings, ReplayFleet &fleet,
                 Wakeup &wakeup)
    : _files(files),
      _end(settings.To),
      _fleet(fleet),
      _wakeup(wakeup),
      _timeline(files.Messages(), settings, Now()),
      _keys([&wakeup] { wakeup.Notify(); })
{
    if (_keys.IsThere())
    {
        Output::Talk("space pauses, s steps, comma and full stop go 10 s back and on, q ends");
    }
}

int Playing::Run()
{
    while (!_wakeup.IsInterrupted() && !_quits && !_timeline.IsAtEnd(Now()))
    {
        PlayDue();
        if (!LookAround())
        {
            return ProblemFound;
        }
        Wait();
        Obey();
    }
    return Good;
}

// Plays messages that are due, until the next look at the latest.
void Playing::PlayDue()
{
    const Duration end = Now() + Look;
    std::vector<ReplayTimeline::Due> restored;
    while ((Now() < end || !restored.empty()) && !_wakeup.IsInterrupted())
    {
        auto due = _timeline.Next(Now());
        if (due && due->IsRestored)
        {
            restored.push_back(std::move(*due));
            continue;
        }
        if (_timeline.Jumps() != _jumps)
        {
            _jumps = _timeline.Jumps();
            _fleet.Jump(restored, _timeline.JumpedTo());
            restored.clear();
        }
        if (!due)
        {
            return;
        }
        _fleet.Play(*due);
    }
}

// Follows the nodes, every `Look`. Returns false if another node has come under one of the names.
bool Playing::LookAround()
{
    const Duration now = Now();
    if (now < _nextLook)
    {
        return true;
    }
    _nextLook = now + Look;
    _fleet.Follow(_timeline.Position(now));
    const std::string twice = _fleet.TwiceName();
    if (!twice.empty())
    {
        Output::Talk(NameIsTaken(twice));
    }
    return twice.empty();
}

void Playing::Wait()
{
    const Duration now = Now();
    const Duration until = std::min(_timeline.DueAt(now).value_or(_nextLook), _nextLook);
    const auto at = std::chrono::steady_clock::now() + (until - now);
    _wakeup.WaitUntil(at, [this] { return (_key = _keys.Take()).has_value(); });
}

void Playing::Obey()
{
    for (; _key; _key = _keys.Take())
    {
        Obey(*_key);
    }
}

void Playing::Obey(char key)
{
    const Duration now = Now();
    const Replay::Time position = _timeline.Position(now);
    switch (key)
    {
        case ' ':
            _timeline.IsPaused() ? _timeline.Resume(now) : _timeline.Pause(now);
            Output::Talk((_timeline.IsPaused() ? "paused at " : "goes on at ") + Place());
            break;
        case 's':
            _timeline.Step(now);
            PlayDue();
            Output::Talk("paused at " + Place());
            break;
        case ',':
        case '.':
            _timeline.Seek(key == '.' ? position + Leap : position - std::min(position, Leap), now);
            Output::Talk("at " + Place());
            break;
        case 'q':
            _quits = true;
            break;
        default:
            break;
    }
}

std::string Playing::Place() const
{
    const Replay::Time first = _files.Messages().First();
    return SecondsText(first, _timeline.Position(Now())) + " of " + SecondsText(first, _end);
}

}  // namespace Rabit::Tool
