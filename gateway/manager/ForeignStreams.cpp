#include "manager/ForeignStreams.h"

#include <algorithm>

namespace Rabit
{

void ForeignStreams::Open()
{
    const std::size_t count = _publishers != nullptr ? _publishers->size() : 0;
    while (_streams.size() < count)
    {
        _streams.push_back(_schedule.AddStream(TrafficClass::Foreign));
    }
}

void ForeignStreams::Look(Duration now)
{
    for (std::size_t i = 0; i < _streams.size(); ++i)
    {
        ForeignPublisher &publisher = (*_publishers)[i];
        publisher.Fetch();
        if (publisher.DueAt(now) <= now)
        {
            _schedule.Ready(_streams[i], publisher.NextBytes());
        }
        else
        {
            _schedule.NotReady(_streams[i]);
        }
    }
}

ForeignStreams::Duration ForeignStreams::NextDue(Duration now) const
{
    Duration next = Duration::max();
    for (std::size_t i = 0; i < _streams.size(); ++i)
    {
        const Duration due = (*_publishers)[i].DueAt(now);
        next = due > now ? std::min(next, due) : next;
    }
    return next;
}

bool ForeignStreams::Send(StreamId id, Duration now)
{
    const auto stream = std::find(_streams.begin(), _streams.end(), id);
    if (stream == _streams.end())
    {
        return false;
    }
    ForeignPublisher &publisher = (*_publishers)[static_cast<std::size_t>(stream - _streams.begin())];
    publisher.Fetch();
    publisher.WriteNext(now);
    return true;
}

ForeignStreams::Duration ForeignStreams::SendAll(Duration now)
{
    Duration next = Duration::max();
    for (std::size_t i = 0; i < _streams.size(); ++i)
    {
        next = std::min(next, (*_publishers)[i].WriteDue(now));
    }
    return next;
}

std::uint64_t ForeignStreams::SentBytes() const
{
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < _streams.size(); ++i)
    {
        bytes += (*_publishers)[i].SentBytes();
    }
    return bytes;
}

}  // namespace Rabit
