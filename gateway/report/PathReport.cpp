#include "report/PathReport.h"

#include <rabit/gateway/ClassRates.h>

#include <algorithm>

#include "report/FleetReport.h"

namespace Rabit::PathReport
{
namespace
{

Gateway::PathToNode RowOf(const std::string &path, const PeerTable::Peer &peer, std::chrono::nanoseconds now)
{
    Gateway::PathToNode row;
    row.path = path;
    row.state = peer.State;
    row.last_heard_s = FleetReport::LastHeardSeconds(peer, now);
    row.round_trip_s = FleetReport::RoundTripSeconds(peer);
    return row;
}

}  // namespace

void FillNodes(const PeersOverPaths &peers, const PathChoice &choice, const std::vector<std::string> &names,
               std::chrono::nanoseconds now, Gateway::Fleet &fleet)
{
    for (Gateway::NodeStatus &node : fleet.nodes)
    {
        node.path = names[choice.Of(node.node)];
        for (std::size_t path = 0; path < names.size(); ++path)
        {
            if (const PeerTable::Peer *const peer = peers.FindOn(path, node.node))
            {
                node.paths.push_back(RowOf(names[path], *peer, now));
            }
        }
    }
}

// A post that one path has sent is not replaced. A path without nodes writes nothing.
void Add(const Gateway::PublicationStatus &other, Gateway::PublicationStatus &status)
{
    status.offered = std::max(status.offered, other.offered);
    status.written += other.written;
    status.replaced = std::min(status.replaced, other.replaced);
    status.write_failures += other.write_failures;
    status.readers = std::max(status.readers, other.readers);
}

void Add(const Gateway::AirStatus &other, Gateway::AirStatus &air)
{
    air.used += other.used;
    air.discovery += other.discovery;
    for (const auto &[name, rate] : ClassRates)
    {
        air.*rate += other.*rate;
    }
}

}  // namespace Rabit::PathReport
