// The receiving half of LinkDriver: frames of other nodes, on the transport's threads.
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include <utility>

#include "presence/PeerTable.h"
#include "queues/LinkDriver.h"
#include "wire/LinkSampleCodec.h"

namespace Rabit
{

// Each transport thread has one frame and one news object, so that steady traffic allocates nothing for names
// and lists. The sender is the participant that DDS reports: a node cannot use another's name. Frames from a
// name that no configuration can have are dropped: an answer would go to the partition of that name, and `*`
// is everybody's.
void LinkDriver::OnFrame(SampleBytes bytes, const SampleInfo &info, Way &way)
{
    static thread_local LinkFrame frame;
    std::span<const std::uint8_t> encoded;
    if (!IsNodeName(info.Node) || !OpenLinkSample(bytes, encoded) || encoded.empty())
    {
        ++_malformed;
        return;
    }
    for (const auto &[firstByte, take] : way.Others)
    {
        if (encoded[0] == firstByte)
        {
            take(info.Node, encoded);
            return;
        }
    }
    if (encoded[0] != LinkVersion)
    {
        const std::lock_guard lock(_mutex);
        _recent.Note({std::string("node ").append(info.Node), "",
                      "its gateway speaks version " + std::to_string(encoded[0]) +
                          " of the queue links, this one version " + std::to_string(LinkVersion) +
                          ": no queue message passes between them"},
                     Now());
        return;
    }
    if (!LinkFrameCodec::Decode(encoded, frame) ||
        (frame.HasData && !frame.Data.Queue.empty() && !IsMessageName(frame.Data.Queue)))
    {
        ++_malformed;
        return;
    }
    frame.Source = info.Node;
    News &news = OwnNews();
    bool sooner = false;
    bool large = false;
    {
        const std::lock_guard lock(_mutex);
        const LinkTime now = Now();
        if (_links->OnFrame(frame, now))
        {
            if (way.Delays.Heard(info.Node, info.Incarnation, LinkTime(frame.Time), now))
            {
                _anyDelays = true;
            }
            if (_ways.size() > 1)
            {
                NoteCame(info, frame, way.Number);
            }
        }
        NoteRaises(now);
        sooner = ServeBy(_outbox.IsEmpty() ? _links->NextDue() : LinkTime(0));
        large = _incoming.AnyUndecoded();
        TakeNews(news);
    }
    TellAndDecode(news, large);
    if (sooner)
    {
        _wake();
    }
    frame.Data.Items.clear();  // they point to bytes that are only borrowed
}

void LinkDriver::NoteCame(const SampleInfo &info, const LinkFrame &frame, std::size_t path)
{
    const std::uint32_t bit = std::uint32_t{1} << path;
    auto node = _came.find(info.Node);
    if (node == _came.end() && _came.size() < PeerTable::MaximumPeers)
    {
        node = _came.emplace(info.Node, Came()).first;
    }
    if (node == _came.end())
    {
        return;
    }
    Came &came = node->second;
    if (info.Incarnation < came.Incarnation)
    {
        return;  // a late frame
    }
    if (came.Incarnation != info.Incarnation || frame.Time > came.Newest)
    {
        came.Incarnation = info.Incarnation;
        came.Newest = frame.Time;
        came.By.First |= bit;
    }
    came.By.Messages |= frame.HasData ? bit : 0;
}

std::map<std::string, LinkDriver::CameBy> LinkDriver::TakeCameBy()
{
    const std::lock_guard lock(_mutex);
    std::map<std::string, CameBy> cameBy;
    for (auto &[node, came] : _came)
    {
        if ((came.By.First | came.By.Messages) != 0)
        {
            cameBy.emplace(node, std::exchange(came.By, {}));
        }
    }
    return cameBy;
}

void LinkDriver::NoteRaises(LinkTime now)
{
    const bool raised = _lastIncarnation != 0 && _lastIncarnation != _links->Incarnation();
    _lastIncarnation = _links->Incarnation();
    if (raised && _links->NameInUseElsewhere())
    {
        Gateway::Problem problem;
        problem.subject = "node " + _config.Node;
        problem.reason =
            "another live node must have the name of this one: it makes this one start its queues "
            "anew again and again. Give one of them another name";
        _recent.Note(problem, now);
    }
}

void LinkDriver::TellAndDecode(News &news, bool large)
{
    Tell(news);
    if (large)
    {
        DecodeLarge(news);
    }
    news.Clear();
}

void LinkDriver::DecodeLarge(News &news)
{
    std::vector<IncomingQueues::Undecoded> large;
    for (;;)
    {
        news.Clear();
        large.clear();
        {
            const std::lock_guard lock(_mutex);
            _incoming.TakeUndecoded(large);
        }
        if (large.empty())
        {
            return;
        }
        for (const IncomingQueues::Undecoded &message : large)
        {
            std::shared_ptr<void> decoded = _incoming.Decode(message);
            bool sooner = false;
            {
                const std::lock_guard lock(_mutex);
                _links->Prepared(message.Source, message.Queue, message.SenderLife, message.Number,
                                 std::move(decoded), Now());
                sooner = ServeBy(LinkTime(0));
                TakeNews(news);
            }
            if (sooner)
            {
                _wake();
            }
            Tell(news);
            news.Clear();
        }
    }
}

void LinkDriver::TakeDelays(std::size_t path, Duration now,
                            const std::function<void(const std::string &, Duration, Duration)> &take)
{
    const std::lock_guard lock(_mutex);
    for (const DelayMeter::Report &report : _ways[path]->Delays.Take(DelayMeter::MostPeers, now))
    {
        take(*report.Node, report.Delay, now - report.Held);
    }
    // The other paths are asked in the same turn.
    _anyDelays = path + 1 < _ways.size() && _anyDelays;
}

}  // namespace Rabit
