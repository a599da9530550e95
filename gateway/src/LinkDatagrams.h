#pragma once

#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit
{

enum class LinkTopic
{
    Data,
    Ack,
    Hello
};

// Datagrams that wait for the gateway's thread, encoded. Memory of sent ones is used again. Not thread-safe.
class LinkDatagrams
{
public:
    struct Datagram
    {
        LinkTopic Topic = LinkTopic::Data;
        std::string Destination;
        std::vector<std::uint8_t> Bytes;
    };

    void Add(LinkTopic topic, std::string_view destination, const MessageType &type,
             const RabitMessage &sample);
    bool IsEmpty() const { return _used == 0; }
    void Clear() { _used = 0; }
    void Swap(LinkDatagrams &other) noexcept
    {
        _datagrams.swap(other._datagrams);
        std::swap(_used, other._used);
    }
    const Datagram *begin() const { return _datagrams.data(); }
    const Datagram *end() const { return _datagrams.data() + _used; }

private:
    std::vector<Datagram> _datagrams;
    std::size_t _used = 0;
};

// The writers for links: one for each topic and destination, in the destination's partition, so that nobody
// else receives what is not for him; made when first used. Gateway's thread only.
class LinkWriters
{
public:
    explicit LinkWriters(TransportSession &session) : _session(session) {}

    // A failure is the transport's to count; the links repair what is lost.
    void Write(const LinkDatagrams::Datagram &datagram, std::int64_t sourceTime);

private:
    TransportSession &_session;
    std::map<std::pair<LinkTopic, std::string>, std::unique_ptr<TransportWriter>> _writers;
};

// The topic, its DDS settings, and its type.
TopicDescription DescribeLinkTopic(LinkTopic topic);
TopicQos LinkTopicQos(LinkTopic topic);

}  // namespace Rabit
