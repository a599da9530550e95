#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit
{

// Frames that wait for the gateway's thread. The memory of sent frames is reused. Not thread-safe.
class LinkDatagrams
{
public:
    struct Datagram
    {
        std::string Destination;
        std::string Queue;  // of its messages; empty: it has none
        LinkFrame Frame;    // encoded when it is written, straight into the transport's memory
    };

    // Keeps the payloads, and the names but for the source's and the types', which must stay valid until the
    // datagram is written (as LinkOutput::Send says). Call BindNames before it is.
    void Add(const LinkFrame &frame, std::string_view queue);
    // Once no more are added: has the frames name their destinations and queues out of this object's memory.
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
    std::vector<Datagram> _datagrams;
    std::size_t _used = 0;
};

}  // namespace Rabit
