#include "queues/LinkWriters.h"

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
    std::unique_ptr<TransportWriter> &writer = _writers[{datagram.Topic, datagram.Destination}];
    if (!writer)
    {
        writer = _session.CreateWriter(DescribeLinkTopic(datagram.Topic), LinkTopicQos(datagram.Topic),
                                       {datagram.Destination});
    }
    const WriteResult result = datagram.Topic == LinkTopic::Data
                                   ? writer->Write(LinkDataEncoder(datagram.Data), sourceTime)
                                   : writer->Write(BytesEncoder(datagram.Buffer.Bytes()), sourceTime);
    static_cast<void>(result);
}

}  // namespace Rabit
