#pragma once

#include <rabit/transport/Transport.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "queues/LinkDatagrams.h"
#include "wire/LinkTopics.h"

namespace Rabit
{

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

}  // namespace Rabit
