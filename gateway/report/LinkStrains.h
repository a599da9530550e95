#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "presence/PeerTable.h"
#include "wire/LinkStrain.h"

namespace Rabit
{

// Which of this node's links are in trouble, for its beats to say: an outbox that fills, messages in doubt, a
// queue that is full. Most are not, and then there is nothing to say. No I/O, no threads, no clock of its
// own; gateway's thread only.
class LinkStrains
{
public:
    using Duration = std::chrono::nanoseconds;

    // An outbox is worth a word from here on.
    static constexpr double MuchFilled = 0.5;
    // What was refused or came in doubt is told for so long after it happened last.
    static constexpr Duration Memory = std::chrono::seconds(30);
    // A queue that is full for less than this is one whose manager works through it.
    static constexpr Duration Short = std::chrono::seconds(2);

    // Links and inbound streams as in that message; nodes that are not in the table are left out. The worst
    // come first: refused, filling, in doubt, held back; one for each node and kind. `now` never goes back.
    std::vector<LinkStrain> Look(const Gateway::Fleet &fleet, const PeerTable &peers, Duration now);

private:
    // A counter that only rises, and by how much it did lately.
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

    void LookAtLinks(const Gateway::Fleet &fleet, const PeerTable &peers, Duration now,
                     std::vector<LinkStrain> &strains);
    void LookAtStreams(const Gateway::Fleet &fleet, const PeerTable &peers, Duration now,
                       std::vector<LinkStrain> &strains);

    std::map<Name, Link> _links;
    std::map<Name, Stream> _streams;  // that are full
};

}  // namespace Rabit
