// NetworkCore: sizes of the simulated datagrams in RTPS; OMG DDSI-RTPS 2.3, 9.4.
#include <algorithm>
#include <set>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

namespace
{

constexpr std::uint64_t IpAndUdp = 20 + 8;
constexpr std::uint64_t Header = 20;
constexpr std::uint64_t Timestamp = 12;    // INFO_TS
constexpr std::uint64_t Destination = 16;  // INFO_DST
constexpr std::uint64_t Data = 24;
constexpr std::uint64_t Heartbeat = 32;
constexpr std::uint64_t Acknowledgement = 28;
// Size of an announcement, measured with Fast DDS.
constexpr std::uint64_t Participant = 232;

}  // namespace

std::uint64_t NetworkCore::CountDestinations(const ParticipantState &me, const WriterState &writer)
{
    std::set<ParticipantId> participants;
    for (const auto &[id, reader] : writer.Readers)
    {
        participants.insert(id.Participant);
    }
    return IsMulticastForData(me.Settings) ? std::min<std::uint64_t>(participants.size(), 1)
                                           : participants.size();
}

NetworkCore::Cost NetworkCore::CostOfPart(const Sample &sample)
{
    return {1, IpAndUdp + Header + Timestamp + Data +
                   (sample.Bytes.size() + sample.Datagrams - 1) / sample.Datagrams};
}

NetworkCore::Cost NetworkCore::CostOf(const ParticipantState &me, const Datagram &datagram)
{
    const auto discovery = [&](std::uint64_t bytes)
    {
        const std::uint64_t packets = (bytes + me.Settings.MaxDatagram - 1) / me.Settings.MaxDatagram;
        return Cost{static_cast<std::uint32_t>(packets), IpAndUdp + Header + bytes / packets, true};
    };
    switch (datagram.What)
    {
        case Datagram::Kind::Data:
        {
            const std::uint32_t *missing = MissingOf(me, datagram);
            const Sample &sample = *datagram.Content;
            Cost cost = CostOfPart(sample);
            cost.Packets = missing != nullptr ? *missing : sample.Datagrams;
            return cost;
        }
        case Datagram::Kind::Heartbeat:
            return {1, IpAndUdp + Header + Destination + Heartbeat};
        case Datagram::Kind::Acknowledgement:
            return {1, IpAndUdp + Header + Destination + Acknowledgement};
        case Datagram::Kind::Announce:
        case Datagram::Kind::Bye:
            return discovery(Timestamp + Data + Participant);
        case Datagram::Kind::Card:
            return discovery(datagram.Card->size() - Header);
        case Datagram::Kind::Introduction:
            return {1, IpAndUdp + datagram.Sealed->size(), true};
    }
    return {};
}

void NetworkCore::Count(const ParticipantState &me, const Cost &cost)
{
    const std::uint64_t bytes = cost.Packets * (cost.Bytes - IpAndUdp);
    cost.IsDiscovery ? me.Log->SentDiscovery(cost.Packets, bytes) : me.Log->SentSamples(cost.Packets, bytes);
    SimulatedSent &sent = _sent[me.NodeNumber];
    sent.Datagrams += cost.Packets;
    sent.Bytes += cost.Packets * cost.Bytes;
    sent.DiscoveryBytes += cost.IsDiscovery ? cost.Packets * cost.Bytes : 0;
}

}  // namespace Rabit::Simulated
