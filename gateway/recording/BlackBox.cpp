#include "recording/BlackBox.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace Rabit
{

BlackBox::BlackBox(std::chrono::nanoseconds before, std::chrono::nanoseconds after, std::size_t mostBytes)
    : _before(static_cast<Time>(before.count())),
      _after(static_cast<Time>(after.count())),
      _mostBytes(mostBytes)
{
}

void BlackBox::Take(RecordingInbox::Batch &batch, Time now)
{
    _letGo.clear();
    for (RecordingItem &item : batch.Items)
    {
        _bytes += RecordingInbox::SizeOf(item);
        _kept.push_back(std::move(item));
    }
    batch.Items.clear();
    for (const Time event : batch.Events)
    {
        if (!_isOpen)
        {
            LetGoOfOld(event);
        }
        _until = std::max(_until, event + _after);
        _isOpen = true;
    }
    if (!_isOpen)
    {
        LetGoOfOld(now);
    }
    if (_isOpen)
    {
        // Items from after the end wait for the next event.
        while (!_kept.empty() && _kept.front().LogTime <= _until)
        {
            _bytes -= RecordingInbox::SizeOf(_kept.front());
            batch.Items.push_back(std::move(_kept.front()));
            _kept.pop_front();
        }
        _isOpen = now <= _until && _kept.empty();
    }
}

void BlackBox::LetGoOfOld(Time now)
{
    while (!_kept.empty() && (_kept.front().LogTime + _before < now || _bytes > _mostBytes))
    {
        _bytes -= RecordingInbox::SizeOf(_kept.front());
        _letGo.push_back(std::move(_kept.front()));
        _kept.pop_front();
    }
}

}  // namespace Rabit
