#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "queues/LinkDatagrams.h"

namespace Rabit
{

// The writers for links: one for each destination, in the destination's partition, so that nobody
// else receives what is not for him; made when first used. When there are very many, the one that was not
// used for longest is given up; the links repair what it had not got through. Gateway's thread only.
class LinkWriters
{
public:
    explicit LinkWriters(TransportSession &session) : _session(session) {}

    // A failure is the transport's to count; the links repair what is lost.
    void Write(const LinkDatagrams::Datagram &datagram, std::int64_t sourceTime);
    // Gives up the writer for that node.
    void Forget(const std::string &node);

private:
    // One for each of the nodes that presence and links remember.
    static constexpr std::size_t MostWriters = 1024;

    struct Entry
    {
        std::unique_ptr<TransportWriter> Writer;
        std::uint64_t LastUse = 0;
    };

    void MakeRoom();

    TransportSession &_session;
    std::map<std::string, Entry> _writers;
    std::uint64_t _uses = 0;
};

}  // namespace Rabit
