#include "manager/LinkStreams.h"

#include <algorithm>
#include <utility>

#include "manager/ImportanceOf.h"

namespace Rabit
{
namespace
{

constexpr LinkStreams::Duration Unused = std::chrono::minutes(1);

}  // namespace

LinkStreams::LinkStreams(const std::vector<SendRule> &rules, LinkDriver &links, AirSchedule &schedule,
                         CopiesTo copies, const PathChoice &choice, std::size_t path)
    : _rules(rules),
      _links(links),
      _schedule(schedule),
      _copies(std::move(copies)),
      _choice(choice),
      _path(path),
      _visit([this](const LinkStream &link) { Visit(link); })
{
}

void LinkStreams::Look(std::size_t most, Duration now)
{
    ++_looks;
    _now = now;
    _links.VisitStreams(most, _visit);
    for (Stream *stream : _byIndex)
    {
        if (stream != nullptr && stream->IsReady && stream->SeenIn != _looks)
        {
            _schedule.NotReady(stream->Id);
            stream->IsReady = false;
        }
    }
    if (now >= _nextSweep)
    {
        Sweep(now);
        _nextSweep = now + Unused;
    }
}

void LinkStreams::Visit(const LinkStream &link)
{
    if (_choice.Of(link.Destination) != _path)
    {
        return;
    }
    Stream &stream = StreamOf(link);
    stream.SeenIn = _looks;
    stream.ReadyAt = _now;
    stream.IsReady = true;
    _schedule.Ready(stream.Id, link.Bytes * _copies(link.Destination));
}

LinkStreams::Stream &LinkStreams::StreamOf(const LinkStream &link)
{
    auto node = _nodes.find(link.Destination);
    if (node == _nodes.end())
    {
        node = _nodes.emplace(link.Destination, Queues()).first;
    }
    auto queue = node->second.find(link.Queue);
    if (queue != node->second.end())
    {
        return queue->second;
    }
    queue = node->second.emplace(link.Queue, Stream()).first;
    Stream &stream = queue->second;
    stream.Node = &node->first;
    stream.Queue = &queue->first;
    const Importance importance = ImportanceOf(_rules, link.Destination, link.Queue);
    stream.Id = link.Queue.empty() ? _schedule.AddStream(TrafficClass::Command)
                                   : _schedule.AddStream(importance.Class, importance.Weight);
    if (_byIndex.size() <= stream.Id.Index)
    {
        _byIndex.resize(stream.Id.Index + 1, nullptr);
    }
    _byIndex[stream.Id.Index] = &stream;
    return stream;
}

bool LinkStreams::Send(StreamId id, std::size_t most, Duration now, bool &sent)
{
    if (id.Index >= _byIndex.size() || _byIndex[id.Index] == nullptr || !(_byIndex[id.Index]->Id == id))
    {
        return false;
    }
    const Stream &stream = *_byIndex[id.Index];
    // A link only estimates the size of its next datagram.
    const std::size_t copies = _copies(*stream.Node);
    sent = _links.SendOne(_path, *stream.Node, *stream.Queue, _schedule.Room(most * copies, now) / copies);
    return true;
}

void LinkStreams::Sweep(Duration now)
{
    for (auto node = _nodes.begin(); node != _nodes.end();)
    {
        std::erase_if(node->second,
                      [this, now](const auto &queue)
                      {
                          const Stream &stream = queue.second;
                          const bool unused = !stream.IsReady && now - stream.ReadyAt > Unused;
                          if (unused)
                          {
                              _byIndex[stream.Id.Index] = nullptr;
                              _schedule.Remove(stream.Id);
                          }
                          return unused;
                      });
        node = node->second.empty() ? _nodes.erase(node) : std::next(node);
    }
}

}  // namespace Rabit
