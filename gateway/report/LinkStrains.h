#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"
#include "wire/LinkStrain.h"

namespace Rabit
{

// Finds this node's links that are in trouble, for its beats to tell: an outbox that fills, messages in
// doubt, a stream that is held back by a full queue. No I/O, no threads, no clock of its own; gateway's
// thread only.
class LinkStrains
{
public:
    using Duration = std::chrono::nanoseconds;

    // An outbox that is filled to this part or more is reported.
    static constexpr double MuchFilled = 0.5;
    // Refused messages and messages in doubt are reported until 30 s after the last one.
    static constexpr Duration Memory = std::chrono::seconds(30);
    // A queue that is full for less than this is not reported: its manager works through it.
    static constexpr Duration Short = std::chrono::seconds(2);

    // Looks at the links and inbound streams in `fleet`, and ignores nodes that are not in `peers`. Returns
    // one strain for each node and kind, the worst first: refused, filling, in doubt, held back. `now`
    // never goes back.
    std::vector<LinkStrain> Look(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now);

private:
    // A counter that only rises, and its rise since it last stood still for longer than `Memory`.
    struct Rise
    {
        std::uint64_t Seen = 0;
        std::uint64_t Lately = 0;
        Duration Last{0};

        std::uint64_t Look(std::uint64_t count, Duration now);
    };
    struct Link
    {
        Rise Refused;
        Rise InDoubt;
        bool IsThere = false;
    };
    struct Stream
    {
        Duration FullSince{0};
        bool IsFull = false;
    };
    using Name = std::pair<std::string, std::string>;  // node, queue

    void LookAtLinks(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                     std::vector<LinkStrain> &strains);
    void LookAtStreams(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                       std::vector<LinkStrain> &strains);

    std::map<Name, Link> _links;
    std::map<Name, Stream> _streams;  // that are full
};

}  // namespace Rabit
