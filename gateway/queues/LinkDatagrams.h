#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
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

// Memory for one datagram. Unlike a std::vector it is not filled with zeros before it is written.
class DatagramBuffer
{
public:
    // What it held is lost.
    std::span<std::uint8_t> Resize(std::size_t size)
    {
        if (size > _capacity)
        {
            _memory = std::make_unique_for_overwrite<std::uint8_t[]>(size);
            _capacity = size;
        }
        _size = size;
        return {_memory.get(), _size};
    }
    std::span<const std::uint8_t> Bytes() const { return {_memory.get(), _size}; }

private:
    std::unique_ptr<std::uint8_t[]> _memory;
    std::size_t _capacity = 0;
    std::size_t _size = 0;
};

// Datagrams that wait for the gateway's thread. Memory of sent ones is used again. Not thread-safe.
class LinkDatagrams
{
public:
    struct Datagram
    {
        LinkTopic Topic = LinkTopic::Data;
        std::string Destination;
        LinkData Data;  // of topic Data: encoded when it is written, straight into the transport's memory
        DatagramBuffer Buffer;  // of the others: encoded
    };

    // Keeps the payloads. The names must stay valid until the datagram is written (as LinkOutput::Send says).
    void Add(const LinkData &data);
    // Encodes it now. What cannot be encoded is left out.
    void Add(LinkTopic topic, std::string_view destination, const MessageType &type,
             const RabitMessage &sample);
    bool IsEmpty() const { return _used == 0; }
    void Clear();
    void Swap(LinkDatagrams &other) noexcept
    {
        _datagrams.swap(other._datagrams);
        std::swap(_used, other._used);
    }
    const Datagram *begin() const { return _datagrams.data(); }
    const Datagram *end() const { return _datagrams.data() + _used; }

private:
    Datagram &Next(LinkTopic topic, std::string_view destination);

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
