#include "report/HandlerWatch.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "report/RoughTime.h"

namespace Rabit
{
namespace
{

using Duration = HandlerWatch::Duration;

std::string Seconds(Duration time)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f s", std::chrono::duration<double>(time).count());
    return text;
}

Gateway::Problem Row(const std::string &subject, std::string reason)
{
    return Gateway::Problem{"handler of " + subject, "", std::move(reason)};
}

}  // namespace

void HandlerWatch::Begins(const std::string &subject)
{
    const Duration now = _clock.Monotonic();
    const std::lock_guard lock(_mutex);
    _running = Call{subject, now};
}

void HandlerWatch::Returned()
{
    const Duration now = _clock.Monotonic();
    const std::lock_guard lock(_mutex);
    const Call call = *std::exchange(_running, std::nullopt);
    if (now - call.Since < Slow)
    {
        return;
    }
    if (_past.size() >= MostRows && _past.count(call.Subject) == 0)
    {
        _past.erase(std::min_element(_past.begin(), _past.end(),
                                     [](const auto &one, const auto &other)
                                     { return one.second.ReturnedAt < other.second.ReturnedAt; }));
    }
    _past[call.Subject] = {now - call.Since, now};
}

std::vector<Gateway::Problem> HandlerWatch::Problems(Duration now) const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> rows;
    const bool isStuck = _running && now - _running->Since >= Slow;
    if (isStuck)
    {
        rows.push_back(Row(_running->Subject, "it has not returned for more than " +
                                                  RoughTime(now - _running->Since) +
                                                  "; the handlers of other messages wait for it"));
    }
    for (const auto &[subject, past] : _past)
    {
        if (now - past.ReturnedAt < Memory && !(isStuck && subject == _running->Subject))
        {
            rows.push_back(Row(
                subject, "it took " + Seconds(past.Took) + "; the handlers of other messages waited for it"));
        }
    }
    return rows;
}

}  // namespace Rabit
