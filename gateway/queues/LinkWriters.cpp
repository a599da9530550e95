#include "queues/LinkWriters.h"

#include <algorithm>

#include "wire/LinkSampleCodec.h"
#include "wire/LinkTopics.h"

namespace Rabit
{

void LinkWriters::Write(const LinkDatagrams::Datagram &datagram, std::int64_t sourceTime)
{
    Entry &entry = _writers[datagram.Destination];
    entry.LastUse = ++_uses;
    std::unique_ptr<TransportWriter> &writer = entry.Writer;
    if (!writer)
    {
        MakeRoom();
        writer = _session.CreateWriter(DescribeLinkTopic(), LinkTopicQos(), {datagram.Destination});
    }
    const WriteResult result = writer->Write(LinkSampleEncoder(datagram.Frame), sourceTime);
    static_cast<void>(result);
}

void LinkWriters::MakeRoom()
{
    if (_writers.size() > MostWriters)
    {
        _writers.erase(std::min_element(_writers.begin(), _writers.end(),
                                        [](const auto &a, const auto &b)
                                        { return a.second.LastUse < b.second.LastUse; }));
    }
}

void LinkWriters::Forget(const std::string &node)
{
    _writers.erase(node);
}

}  // namespace Rabit
