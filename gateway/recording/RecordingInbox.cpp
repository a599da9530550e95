#include "recording/RecordingInbox.h"

#include <rabit/mcap/McapWriter.h>

#include <stdexcept>
#include <utility>

namespace Rabit
{

std::uint32_t RecordingInbox::AddStream(RecordingStream stream)
{
    auto shared = std::make_shared<const RecordingStream>(std::move(stream));
    const std::lock_guard lock(_mutex);
    _newStreams.push_back(std::move(shared));
    _lost.push_back(0);
    return static_cast<std::uint32_t>(_lost.size() - 1);
}

bool RecordingInbox::Put(RecordingItem item)
{
    const std::size_t size = SizeOf(item);
    bool wake = false;
    {
        const std::lock_guard lock(_mutex);
        if (item.Stream >= _lost.size())
        {
            throw std::invalid_argument("RecordingInbox: no such stream");
        }
        const bool isLarge = item.Data.size() >= Mcap::McapWriter::LargeMessage;
        const std::size_t room = isLarge ? _mostBytes / 4 * 3 : _mostBytes;
        if (_closed || item.Data.size() > Mcap::McapWriter::LargestMessage || _bytes + size > room)
        {
            ++_lost[item.Stream];
            _anyLost = true;
            return false;
        }
        wake = _bytes < _mostBytes / 2 && _bytes + size >= _mostBytes / 2;
        _bytes += size;
        _waiting += size;
        _items.push_back(std::move(item));
    }
    if (wake)
    {
        _changed.notify_one();
    }
    return true;
}

void RecordingInbox::SetMetadata(const std::string &name, Mcap::TextMap values)
{
    const std::lock_guard lock(_mutex);
    _metadata.push_back({name, std::move(values)});
}

void RecordingInbox::Happened(std::uint64_t logTime)
{
    const std::lock_guard lock(_mutex);
    _event = logTime;
}

void RecordingInbox::AddLost(std::uint32_t stream, std::uint64_t count)
{
    const std::lock_guard lock(_mutex);
    if (stream >= _lost.size())
    {
        throw std::invalid_argument("RecordingInbox: no such stream");
    }
    _lost[stream] += count;
    _anyLost = true;
}

void RecordingInbox::Take(Batch &batch, std::chrono::milliseconds wait)
{
    batch.NewStreams.clear();
    batch.Items.clear();
    batch.Metadata.clear();
    batch.Lost.clear();
    batch.Events.clear();
    std::unique_lock lock(_mutex);
    _changed.wait_for(lock, wait, [this] { return _closed || _bytes >= _mostBytes / 2; });
    batch.NewStreams.swap(_newStreams);
    batch.FirstNewStream = _lost.size() - batch.NewStreams.size();
    batch.Items.swap(_items);
    batch.Metadata.swap(_metadata);
    if (std::exchange(_anyLost, false))
    {
        batch.Lost = _lost;
    }
    if (_event)
    {
        batch.Events.push_back(*std::exchange(_event, std::nullopt));
    }
    batch.Bytes = std::exchange(_waiting, 0);
    batch.IsEnd = _closed;
}

void RecordingInbox::Done(const Batch &batch)
{
    const std::lock_guard lock(_mutex);
    _bytes -= batch.Bytes;
}

void RecordingInbox::Close()
{
    {
        const std::lock_guard lock(_mutex);
        _closed = true;
    }
    _changed.notify_all();
}

}  // namespace Rabit
