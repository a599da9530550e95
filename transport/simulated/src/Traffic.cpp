// What the simulated datagrams would cost with RTPS; OMG DDSI-RTPS 2.3, 9.4.
#include <algorithm>
#include <set>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

namespace
{

constexpr std::uint64_t Header = 20;
constexpr std::uint64_t Timestamp = 12;    // INFO_TS
constexpr std::uint64_t Destination = 16;  // INFO_DST
constexpr std::uint64_t Data = 24;
constexpr std::uint64_t Heartbeat = 32;
constexpr std::uint64_t Acknowledgement = 28;
// Of what participants and endpoints say of themselves, names left out.
constexpr std::uint64_t Participant = 350;
constexpr std::uint64_t Endpoint = 250;

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

void NetworkCore::CountSample(const ParticipantState &me, const Sample &sample, std::uint64_t destinations)
{
    const std::uint64_t once = sample.Datagrams * (Header + Timestamp + Data) + sample.Bytes.size();
    me.Log->SentSamples(destinations * sample.Datagrams, destinations * once);
}

void NetworkCore::CountOther(const ParticipantState &me, const Datagram &datagram)
{
    switch (datagram.What)
    {
        case Datagram::Kind::Data:
            break;  // by CountSample
        case Datagram::Kind::Heartbeat:
            me.Log->SentSamples(1, Header + Destination + Heartbeat);
            break;
        case Datagram::Kind::Acknowledgement:
            me.Log->SentSamples(1, Header + Destination + Acknowledgement);
            break;
        case Datagram::Kind::Announce:
        case Datagram::Kind::Bye:
            me.Log->SentDiscovery(1, Header + Timestamp + Data + Participant);
            break;
        case Datagram::Kind::Endpoints:
            me.Log->SentDiscovery(1, Header + Destination + Data + Endpoint * datagram.Endpoints->size());
            break;
        case Datagram::Kind::EndpointsAck:
            me.Log->SentDiscovery(1, Header + Destination + Acknowledgement);
            break;
    }
}

}  // namespace Rabit::Simulated
