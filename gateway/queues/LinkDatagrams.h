#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/idl/MessageType.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "queues/DatagramBuffer.h"
#include "wire/LinkTopics.h"

namespace Rabit
{

// Datagrams that wait for the gateway's thread. Memory of sent ones is used again. Not thread-safe.
class LinkDatagrams
{
public:
    struct Datagram
    {
        LinkTopic Topic = LinkTopic::Data;
        std::string Destination;
        std::string Queue;  // of topic Data
        LinkData Data;      // of topic Data: encoded when it is written, straight into the transport's memory
        DatagramBuffer Buffer;  // of the others: encoded
    };

    // Keeps the payloads, and the names but for the source's and the types', which must stay valid until the
    // datagram is written (as LinkOutput::Send says). Call BindNames before it is.
    void Add(const LinkData &data);
    // Encodes it now. What cannot be encoded is left out.
    void Add(LinkTopic topic, std::string_view destination, const MessageType &type,
             const RabitMessage &sample);
    // Once no more are added: has the data name its destinations and queues out of this object's memory.
    void BindNames();
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

}  // namespace Rabit
