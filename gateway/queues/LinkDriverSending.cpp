// The sending half of LinkDriver: by itself, or one datagram at a time for a scheduler.
#include <rabit/gateway/links/LinkFrameCodec.h>

#include <utility>

#include "clocks/GpsTime.h"
#include "queues/LinkDriver.h"
#include "wire/LinkSampleCodec.h"
#include "wire/LinkTopics.h"

namespace Rabit
{

LinkDriver::Duration LinkDriver::Service()
{
    LinkTime next = LinkNever;
    bool large = false;
    News &news = OwnNews();
    {
        const std::lock_guard lock(_mutex);
        _incoming.Find([this](const std::string &queue) { _links->OnRoom(queue); });
        _links->Run(Now());
        _sending.Swap(_outbox);
        next = _nextService = _links->NextDue();
        large = _incoming.AnyUndecoded();
        TakeNews(news);
    }
    TellAndDecode(news, large);
    WriteOut(0);
    return next;
}

inline void LinkDriver::Write(const LinkDatagrams::Datagram &datagram, TransportWriter *writer,
                              std::int64_t sourceTime)
{
    if (writer != nullptr)
    {
        // The transport counts a failure; the links retransmit lost parts.
        static_cast<void>(
            writer->WriteTo(datagram.Destination, LinkSampleEncoder(datagram.Frame), sourceTime));
    }
}

void LinkDriver::WriteOut(std::size_t path)
{
    if (_sending.IsEmpty())
    {
        return;
    }
    // What is sent now may tell of a new life.
    _incarnations.Save();
    const std::int64_t sourceTime = GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds());
    _sending.BindNames();
    TransportWriter *const writer = WriterOf(path);
    for (const LinkDatagrams::Datagram &datagram : _sending)
    {
        Write(datagram, writer, sourceTime);
        if (_second.Choose)
        {
            const std::size_t bytes = LinkFrameCodec::EncodedSize(datagram.Frame) + AboutTheHeaders;
            const auto second = _second.Choose(datagram.Destination, datagram.Queue, bytes);
            if (second && *second != path)
            {
                Write(datagram, WriterOf(*second), sourceTime);
                _second.Sent(*second);
            }
        }
    }
    _sending.Clear();
}

LinkDriver::Duration LinkDriver::Advance()
{
    LinkTime next = LinkNever;
    bool large = false;
    News &news = OwnNews();
    {
        const std::lock_guard lock(_mutex);
        _incoming.Find([this](const std::string &queue) { _links->OnRoom(queue); });
        _links->Advance(Now());
        next = _links->NextDue();
        _nextService = LinkNever;
        large = _incoming.AnyUndecoded();
        TakeNews(news);
    }
    TellAndDecode(news, large);
    return next;
}

void LinkDriver::VisitStreams(std::size_t most, const std::function<void(const LinkStream &)> &visit) const
{
    const std::lock_guard lock(_mutex);
    _links->VisitStreams(most, Now(), visit);
}

bool LinkDriver::SendOne(std::size_t path, std::string_view destination, std::string_view queue,
                         std::size_t most)
{
    bool sent = false;
    News &news = OwnNews();
    {
        const std::lock_guard lock(_mutex);
        sent = _links->SendOne(destination, queue, most, Now());
        _sending.Swap(_outbox);
        TakeNews(news);
    }
    Tell(news);
    news.Clear();
    WriteOut(path);
    return sent;
}

void LinkDriver::WillServe(Duration at)
{
    const std::lock_guard lock(_mutex);
    _nextService = std::min(_nextService, at);
}

void LinkDriver::SendOther(std::size_t path, const std::string &node, std::span<const std::uint8_t> frame)
{
    if (TransportWriter *const writer = WriterOf(path))
    {
        static_cast<void>(writer->WriteTo(node, FrameBytesEncoder(frame),
                                          GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds())));
    }
}

TransportWriter *LinkDriver::MakeWriter(std::size_t path)
{
    Way *const way = path < _ways.size() ? _ways[path].get() : nullptr;
    if (way == nullptr || way->Session == nullptr)
    {
        return nullptr;
    }
    way->Writer = way->Session->CreateWriter(DescribeLinkTopic(), LinkTopicQos(), {});
    return way->Writer.get();
}

}  // namespace Rabit
