#include "report/LinkStrains.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace Rabit
{
namespace
{

using Kind = LinkStrain::Kind;

std::uint16_t Saturated(std::uint64_t count)
{
    return static_cast<std::uint16_t>(
        std::min<std::uint64_t>(count, std::numeric_limits<std::uint16_t>::max()));
}

// Keeps one strain for each node and kind: several queues of a node are joined, with the worst fill and the
// sum of their messages.
void Add(const LinkStrain &strain, std::vector<LinkStrain> &strains)
{
    const auto found = std::find_if(strains.begin(), strains.end(),
                                    [&strain](const LinkStrain &other)
                                    { return other.Node == strain.Node && other.What == strain.What; });
    if (found == strains.end())
    {
        strains.push_back(strain);
        return;
    }
    found->Percent = std::max(found->Percent, strain.Percent);
    found->Messages = Saturated(std::uint64_t{found->Messages} + strain.Messages);
}

bool IsWorse(const LinkStrain &one, const LinkStrain &other)
{
    const auto rank = [](const LinkStrain &strain)
    {
        const bool lost = strain.What == Kind::Filling && strain.Messages > 0;
        return std::tuple(!lost, strain.What, -strain.Percent);
    };
    return rank(one) < rank(other);
}

}  // namespace

std::uint64_t LinkStrains::Rise::Look(std::uint64_t count, Duration now)
{
    if (now - Last > Memory)
    {
        Lately = 0;
    }
    if (count > Seen)
    {
        Lately += count - Seen;
        Last = now;
    }
    Seen = count;
    return Lately;
}

std::vector<LinkStrain> LinkStrains::Look(const Gateway::Fleet &fleet, const PeersOverPaths &peers,
                                          Duration now)
{
    std::vector<LinkStrain> strains;
    LookAtLinks(fleet, peers, now, strains);
    LookAtStreams(fleet, peers, now, strains);
    std::stable_sort(strains.begin(), strains.end(), IsWorse);
    return strains;
}

void LinkStrains::LookAtLinks(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                              std::vector<LinkStrain> &strains)
{
    for (auto &[name, link] : _links)
    {
        link.IsThere = false;
    }
    for (const Gateway::LinkStatus &status : fleet.links)
    {
        Link &link = _links[{status.node, status.queue}];
        link.IsThere = true;
        const std::uint64_t refused = link.Refused.Look(status.refused_full, now);
        const std::uint64_t inDoubt = link.InDoubt.Look(status.in_doubt, now);
        const PeerTable::Peer *peer = peers.Find(status.node);
        if (peer == nullptr)
        {
            continue;
        }
        if (refused > 0 || status.fill >= MuchFilled)
        {
            const double percent = std::clamp(100.0 * status.fill, 0.0, 100.0);
            Add({peer->Tag, Kind::Filling, static_cast<std::uint8_t>(percent), Saturated(refused)}, strains);
        }
        if (inDoubt > 0)
        {
            Add({peer->Tag, Kind::InDoubt, 0, Saturated(inDoubt)}, strains);
        }
    }
    std::erase_if(_links, [](const auto &entry) { return !entry.second.IsThere; });
}

void LinkStrains::LookAtStreams(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                                std::vector<LinkStrain> &strains)
{
    for (auto &[name, stream] : _streams)
    {
        stream.IsFull = false;
    }
    for (const Gateway::InboundStatus &status : fleet.inbound)
    {
        const PeerTable::Peer *peer = status.held_back ? peers.Find(status.node) : nullptr;
        if (peer == nullptr)
        {
            continue;
        }
        Stream &stream = _streams.try_emplace({status.node, status.queue}, Stream{now, true}).first->second;
        stream.IsFull = true;
        if (now - stream.FullSince >= Short)
        {
            Add({peer->Tag, Kind::HeldBack, 0, 0}, strains);
        }
    }
    std::erase_if(_streams, [](const auto &entry) { return !entry.second.IsFull; });
}

}  // namespace Rabit
