#pragma once

#include "AssemblyMemory.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>

#include <cstddef>
#include <cstdint>

namespace Rabit
{

// State shared by all links of one node. Owned by the LinkNode, which outlives them.
struct LinkContext
{
    LinkContext(LinkSettings settings, LinkOutput &output, LocalQueues &queues, std::uint64_t incarnation);

    const LinkSettings Settings;
    LinkOutput &Output;
    LocalQueues &Queues;
    // The name of this process's clock in frames.
    const std::uint32_t Clock;
    // The incarnation of this node for peers that it meets now: s_inc of all streams to them and r_inc of all
    // their sessions.
    std::uint64_t Incarnation = 0;
    LinkNodeCounters Counters;
    // Reused for each frame sent, so that its vectors keep their memory.
    LinkFrame Frame;
    // Bytes of parts that wait for earlier ones, on all links.
    std::size_t ReorderBytes = 0;
    // Bytes under way on all paths that start.
    std::size_t Starting = 0;
    Rabit::AssemblyMemory AssemblyMemory;
};

}  // namespace Rabit
