#include "report/FleetReport.h"

#include <algorithm>
#include <limits>

#include "presence/Whereabouts.h"

namespace Rabit::FleetReport
{
namespace
{

double Seconds(std::chrono::nanoseconds duration)
{
    return std::chrono::duration<double>(duration).count();
}

Gateway::NodeStatus StatusOf(const PeerTable::Peer &peer, std::chrono::nanoseconds now)
{
    Gateway::NodeStatus status;
    status.node = peer.Node;
    status.state = peer.State;
    status.reason = peer.Reason;
    status.replay = peer.IsReplay;
    status.incarnation = peer.Incarnation;
    status.last_heard_s = LastHeardSeconds(peer, now);
    status.round_trip_s = RoundTripSeconds(peer);
    return status;
}

void AddProblem(const std::string &subject, const std::string &node, const std::string &reason,
                Gateway::Fleet &fleet)
{
    fleet.problems.push_back({subject, node, reason});
}

}  // namespace

double LastHeardSeconds(const PeerTable::Peer &peer, std::chrono::nanoseconds now)
{
    return std::max(0.0, Seconds(now - peer.LastHeard));
}

double RoundTripSeconds(const PeerTable::Peer &peer)
{
    const auto roundTrip = peer.Clock.RoundTrip();
    return roundTrip ? Seconds(*roundTrip) : std::numeric_limits<double>::quiet_NaN();
}

// FillNodes has sorted the rows by name.
Gateway::NodeStatus *NodeIn(Gateway::Fleet &fleet, std::string_view node)
{
    const auto row = std::lower_bound(fleet.nodes.begin(), fleet.nodes.end(), node,
                                      [](const Gateway::NodeStatus &status, std::string_view name)
                                      { return status.node < name; });
    return row == fleet.nodes.end() || row->node != node ? nullptr : &*row;
}

void FillNodes(const PeersOverPaths &peers, std::chrono::nanoseconds now, Gateway::Fleet &fleet)
{
    fleet.nodes.clear();
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        fleet.nodes.push_back(StatusOf(*peer, now));
    }
    for (const Gateway::LinkStatus &link : fleet.links)
    {
        if (Gateway::NodeStatus *const node = NodeIn(fleet, link.node))
        {
            node->outbox += link.outbox;
        }
    }
    for (const Gateway::TopicStatus &topic : fleet.topics)
    {
        if (Gateway::NodeStatus *const node = NodeIn(fleet, topic.node))
        {
            node->messages_received += topic.received;
            node->undecodable += topic.undecodable;
        }
    }
}

namespace
{
// Where the two nodes of one name run, as far as they have told.
std::string PlacesOf(const PeerTable::Peer &peer)
{
    if (!peer.Place.empty() && peer.Place == peer.TwinPlace)
    {
        return "; both are on " + peer.Place;
    }
    return (peer.Place.empty() ? "" : "; one is on " + peer.Place) +
           (peer.TwinPlace.empty() ? "" : "; one is on " + peer.TwinPlace);
}
}  // namespace

void AddNameProblems(const PeersOverPaths &peers, Gateway::Fleet &fleet)
{
    if (peers.OwnNameTwice())
    {
        const std::string &other = peers.OwnTwinPlace();
        AddProblem("node " + fleet.node, "",
                   "another live node has the name of this one; this one is on " +
                       Whereabouts::OfThisProcess() + (other.empty() ? "" : ", the other on " + other),
                   fleet);
    }
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        if (peer->Twice)
        {
            AddProblem("node " + peer->Node, peer->Node, "two live nodes have this name" + PlacesOf(*peer),
                       fleet);
        }
    }
}

void AddNetworkProblems(const std::vector<SettingsProblem> &problems, Gateway::Fleet &fleet)
{
    for (const SettingsProblem &found : problems)
    {
        Gateway::Problem problem;
        problem.subject = found.Setting.empty() ? "network" : found.Setting;
        problem.subject += found.Entry.empty() ? "" : " " + found.Entry;
        problem.reason = found.Text;
        problem.certain = true;
        fleet.problems.push_back(problem);
    }
}

}  // namespace Rabit::FleetReport
