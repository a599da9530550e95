#pragma once

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>

#include <cstdint>

namespace Rabit
{

// What all links of one node share. Owned by the LinkNode, which outlives them.
struct LinkContext
{
    LinkSettings Settings;
    LinkOutput &Output;
    LocalQueues &Queues;
    // The life this node is in to peers that it meets now: s_inc of all streams to them and r_inc of all
    // their sessions.
    std::uint64_t Incarnation = 0;
    LinkNodeCounters Counters;
    // Reused for each datagram sent, so that its vector keeps its memory.
    LinkData Datagram;
};

}  // namespace Rabit
