#include "presence/DelayNotes.h"

#include <algorithm>

#include "names/TakeTurns.h"

namespace Rabit
{
namespace
{

std::uint16_t Milliseconds(DelayNotes::Duration duration)
{
    const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(duration).count();
    return static_cast<std::uint16_t>(std::clamp<std::int64_t>(whole, 0, 0xffff));
}

}  // namespace

bool DelayNotes::Note(Tag node, Duration delay, Duration arrival)
{
    if (_notes.size() >= MostNodes && _notes.count(node) == 0)
    {
        std::erase_if(_notes,
                      [arrival](const auto &note) { return arrival - note.second.Arrival > LongestHeld; });
        if (_notes.size() >= MostNodes)
        {
            return false;
        }
    }
    Entry &entry = _notes[node];
    if (arrival < entry.Arrival)
    {
        return false;
    }
    entry.Delay = delay;
    entry.Arrival = arrival;
    entry.IsNew = true;
    _longAt = delay > LongDelay ? arrival : _longAt;
    return delay >= Large;
}

bool DelayNotes::IsDue(const Entry &entry, Duration now) const
{
    return entry.IsNew && now - entry.Arrival <= LongestHeld &&
           (!IsSmall(entry) || !entry.ToldAt || now - *entry.ToldAt >= _smallPeriod);
}

DelayNotes::Duration DelayNotes::Delay(Duration now) const
{
    std::vector<Duration> delays;
    for (const auto &[node, entry] : _notes)
    {
        if (now - entry.Arrival < Lately)
        {
            delays.push_back(entry.Delay);
        }
    }
    const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
    std::nth_element(delays.begin(), middle, delays.end());
    const Duration delay = delays.empty() ? Duration(0) : *middle;
    return std::min(std::max(delay, _heardLate), LongestQueue);
}

std::size_t DelayNotes::Due(Duration now, std::size_t most) const
{
    std::size_t large = 0;
    std::size_t small = 0;
    for (const auto &[node, entry] : _notes)
    {
        if (IsDue(entry, now))
        {
            ++(IsSmall(entry) ? small : large);
        }
    }
    return std::min(large + std::min(small, MostSmall), most);
}

std::vector<Gateway::DelayReport> DelayNotes::Take(Duration now, std::size_t most)
{
    std::vector<Gateway::DelayReport> reports;
    std::size_t small = 0;
    TakeTurns(_notes, _last, most,
              [&](Tag node, Entry &entry)
              {
                  if (!IsDue(entry, now) || (IsSmall(entry) && ++small > MostSmall))
                  {
                      return false;
                  }
                  Gateway::DelayReport report;
                  report.node = node;
                  report.delay_ms = Milliseconds(entry.Delay);
                  report.held_ms = Milliseconds(now - entry.Arrival);
                  reports.push_back(report);
                  entry.IsNew = false;
                  entry.Told = entry.Delay;
                  entry.ToldAt = now;
                  return true;
              });
    return reports;
}

}  // namespace Rabit
