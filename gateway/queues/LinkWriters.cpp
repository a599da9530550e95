#include "queues/LinkWriters.h"

#include <algorithm>

#include "wire/LinkDataCodec.h"
#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

// Lets the transport encode a LinkData straight into its own buffer.
class LinkDataEncoder final : public SampleEncoder
{
public:
    explicit LinkDataEncoder(const LinkData &data) : _data(data), _size(LinkDataCodec::EncodedSize(data)) {}

    std::size_t EncodedSize() const override { return _size; }
    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        return LinkDataCodec::Encode(_data, buffer);
    }

private:
    const LinkData &_data;
    const std::size_t _size;
};

}  // namespace

void LinkWriters::Write(const LinkDatagrams::Datagram &datagram, std::int64_t sourceTime)
{
    Entry &entry = _writers[{datagram.Topic, datagram.Destination}];
    entry.LastUse = ++_uses;
    std::unique_ptr<TransportWriter> &writer = entry.Writer;
    if (!writer)
    {
        MakeRoom();
        writer = _session.CreateWriter(DescribeLinkTopic(datagram.Topic), LinkTopicQos(datagram.Topic),
                                       {datagram.Destination});
    }
    const WriteResult result = datagram.Topic == LinkTopic::Data
                                   ? writer->Write(LinkDataEncoder(datagram.Data), sourceTime)
                                   : writer->Write(BytesEncoder(datagram.Buffer.Bytes()), sourceTime);
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
    std::erase_if(_writers, [&node](const auto &writer) { return writer.first.second == node; });
}

}  // namespace Rabit
