// `ReadOutgoing` on datagrams that this node sends.
#include "OutgoingMessage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::FastDds::DiscoveryPortsOf;
using Rabit::FastDds::FirstRequest;
using Rabit::FastDds::OutgoingMessage;
using Rabit::FastDds::ReadOutgoing;
using Rabit::Rtps::ParticipantWriter;

constexpr std::uint8_t HasData = 5;  // and little-endian

Bytes To(const GuidPrefix &peer)
{
    return Submessage(InfoDestination, Bytes(peer.begin(), peer.end()));
}

TEST(OutgoingMessage, AnAnnouncementIsOneAndEqualOnesAreTold)
{
    const auto first = ReadOutgoing(ParticipantMessage(Sender, 7410)).Announcement;
    EXPECT_TRUE(first.has_value());
    EXPECT_EQ(ReadOutgoing(ParticipantMessage(Sender, 7410)).Announcement, first);
    EXPECT_NE(ReadOutgoing(ParticipantMessage(Sender, 7412)).Announcement, first);
    EXPECT_FALSE(ReadOutgoing(ParticipantMessage()).HasSamples);
}

TEST(OutgoingMessage, AnAnnouncementTellsThePortsOfDiscovery)
{
    const auto at = [](std::uint16_t id, std::uint32_t port) {
        return Parameter(id, Join({U32(1), U32(port), Bytes(12), {127, 0, 0, 1}}));
    };
    const Bytes parameters = List({Parameter(0x0050, Guid(Sender, 0x000001c1)), at(0x0031, 7411),
                                   at(0x0032, 7410), at(0x0048, 7401), at(0x0033, 7400)});
    const Bytes announcement = Message(Data, DataBody(1, parameters, ParticipantWriter), HasData);
    EXPECT_EQ(DiscoveryPortsOf(announcement), (std::vector<std::uint32_t>{7410, 7400}));
    EXPECT_TRUE(DiscoveryPortsOf(Message(Data, DataBody(1), HasData)).empty());
    EXPECT_TRUE(DiscoveryPortsOf({}).empty());
}

TEST(OutgoingMessage, AGoodbyeIsNoAnnouncement)
{
    constexpr std::uint8_t WithInlineQosAndKey = 1 | 2 | 8;
    const Bytes goodbye = Message(Data, DataBody(1, Bytes(40), ParticipantWriter), WithInlineQosAndKey);
    EXPECT_FALSE(ReadOutgoing(goodbye).Announcement.has_value());
}

TEST(OutgoingMessage, AnAnnouncementBesidesSomethingElseIsNotHeldWithIt)
{
    const Bytes both = Join({ParticipantMessage(), Submessage(Heartbeat, HeartbeatBody(1, 2, 3))});
    EXPECT_FALSE(ReadOutgoing(both).Announcement.has_value());
}

TEST(OutgoingMessage, ARequestOfAReaderThatHasNothingIsTheFirst)
{
    const Bytes request = Join({Header(), To(Other), Submessage(AckNack, AckNackBody(0, 0, 1))});
    EXPECT_EQ(ReadOutgoing(request).Request, (FirstRequest{Other, UserReader, UserWriter}));
}

TEST(OutgoingMessage, ARequestForSomethingOrAnAcknowledgementIsNot)
{
    const Bytes missing = Join({Header(), To(Other), Submessage(AckNack, AckNackBody(1, 3, 1))});
    const Bytes more = Join({Header(), To(Other), Submessage(AckNack, AckNackBody(4, 0, 1))});
    const Bytes acknowledged = Join({Header(), To(Other), Submessage(AckNack, AckNackBody(0, 0, 1), 1 | 2)});
    for (const Bytes &message : {missing, more, acknowledged})
    {
        EXPECT_FALSE(ReadOutgoing(message).Request.has_value());
    }
}

TEST(OutgoingMessage, TwoRequestsInOneAreNotHeldAsOne)
{
    const Bytes both = Join({Header(), To(Other), Submessage(AckNack, AckNackBody(0, 0, 1)),
                             Submessage(AckNack, AckNackBody(0, 0, 1))});
    EXPECT_FALSE(ReadOutgoing(both).Request.has_value());
}

TEST(OutgoingMessage, SamplesAndTheirRepairAreToldFromDiscovery)
{
    constexpr Rabit::Rtps::EntityId Publications = Rabit::Rtps::PublicationsWriter;
    EXPECT_TRUE(ReadOutgoing(Message(Data, DataBody(1), HasData)).HasSamples);
    EXPECT_TRUE(ReadOutgoing(Message(Heartbeat, HeartbeatBody(1, 2, 3))).HasSamples);
    EXPECT_TRUE(ReadOutgoing(Message(AckNack, AckNackBody(4, 0, 1))).HasSamples);
    EXPECT_TRUE(ReadOutgoing(Message(Gap, GapBody(1, 2))).HasSamples);
    EXPECT_FALSE(ReadOutgoing(WriterMessage()).HasSamples);
    EXPECT_FALSE(ReadOutgoing(Message(Heartbeat, HeartbeatBody(1, 2, 3, Publications))).HasSamples);
}

TEST(OutgoingMessage, SamplesForOneAreToldFromSamplesForAllAndFromWhatComesBesides)
{
    const Bytes sample = Submessage(Data, DataBody(1), HasData);
    const Bytes builtin = Submessage(Data, DataBody(1, Bytes(40), Rabit::Rtps::PublicationsWriter), HasData);
    const Bytes heartbeat = Submessage(Heartbeat, HeartbeatBody(1, 2, 3));
    const auto isToOne = [](std::initializer_list<Bytes> parts)
    { return ReadOutgoing(Join(parts)).IsOfSamplesToOne; };
    EXPECT_TRUE(isToOne({Header(), To(Other), sample}));
    EXPECT_TRUE(isToOne({Header(), To(Other), sample, sample}));
    EXPECT_FALSE(isToOne({Header(), sample}));
    EXPECT_FALSE(isToOne({Header(), To(GuidPrefix{}), sample}));
    EXPECT_FALSE(isToOne({Header(), To(Other), sample, To(Sender), sample}));
    EXPECT_FALSE(isToOne({Header(), To(Other), sample, heartbeat}));
    EXPECT_FALSE(isToOne({Header(), To(Other), builtin}));
}

TEST(OutgoingMessage, WithoutItsDestinationTheRestIsAsItWas)
{
    const Bytes time = Submessage(InfoTimestamp, Bytes(8));
    const Bytes sample = Submessage(Data, DataBody(1), HasData);
    Bytes left = {1, 2, 3};
    Rabit::FastDds::WriteWithoutDestination(Join({Header(), To(Other), time, sample}), left);
    EXPECT_EQ(left, Join({Header(), time, sample}));
}

TEST(OutgoingMessage, AnAnnouncementWithoutPropertiesIsTheRestOfIt)
{
    const auto announcement = [](const Bytes &list, const Bytes &behind)
    {
        return Join({Header(), Submessage(InfoTimestamp, Bytes(8)),
                     Submessage(Data, DataBody(1, list, ParticipantWriter), HasData), behind});
    };
    const Bytes name = Parameter(0x0062, Text("uav1"));
    const Bytes properties = Parameter(0x0059, Join({U32(1), Text("PARTICIPANT_TYPE"), Text("SIMPLE")}));
    const Bytes behind = Submessage(Heartbeat, HeartbeatBody(1, 2, 3));
    Bytes left = {1, 2, 3};
    Rabit::FastDds::WriteWithoutProperties(announcement(List({name, properties, name}), behind), left);
    EXPECT_EQ(left, announcement(List({name, name}), behind));
    Rabit::FastDds::WriteWithoutProperties(announcement(List({name}), {}), left);
    EXPECT_EQ(left, announcement(List({name}), {}));
}

TEST(OutgoingMessage, WhatIsNoAnnouncementKeepsItsProperties)
{
    const Bytes other = Message(Data, DataBody(1, List({Parameter(0x0059, Bytes(8))})), HasData);
    Bytes left;
    Rabit::FastDds::WriteWithoutProperties(other, left);
    EXPECT_EQ(left, other);
}

TEST(OutgoingMessage, AHeartbeatAloneIsToldByItsWriterItsNumbersAndWhomItIsFor)
{
    const auto toAll = ReadOutgoing(Message(Heartbeat, HeartbeatBody(2, 5, 7))).Heartbeat;
    ASSERT_TRUE(toAll.has_value());
    EXPECT_EQ(toAll->Writer, UserWriter);
    EXPECT_EQ(toAll->First, 2);
    EXPECT_EQ(toAll->Last, 5);
    EXPECT_EQ(toAll->Peer, GuidPrefix());
    const Bytes toOne = Join({Header(), To(Other), Submessage(Heartbeat, HeartbeatBody(2, 5, 7))});
    ASSERT_TRUE(ReadOutgoing(toOne).Heartbeat.has_value());
    EXPECT_EQ(ReadOutgoing(toOne).Heartbeat->Peer, Other);
}

TEST(OutgoingMessage, AHeartbeatBesidesSomethingElseIsNotHeldWithIt)
{
    for (const Bytes &other : {Submessage(Data, DataBody(1), HasData), Submessage(Gap, GapBody(1, 2)),
                               Submessage(Heartbeat, HeartbeatBody(2, 5, 7))})
    {
        const Bytes both = Join({Header(), other, Submessage(Heartbeat, HeartbeatBody(2, 5, 7))});
        EXPECT_FALSE(ReadOutgoing(both).Heartbeat.has_value());
    }
}

TEST(OutgoingMessage, AcknowledgementsSayWhatTheyHaveAndWhetherTheyAsk)
{
    const Bytes message =
        Join({Header(), To(Other), Submessage(AckNack, AckNackBody(4, 0, 1), 1 | 2),
              Submessage(AckNack, AckNackBody(4, 2, 1)), Submessage(AckNack, AckNackBody(0, 0, 1))});
    const auto found = Rabit::FastDds::ReadAcknowledgements(message);
    ASSERT_EQ(found.size(), 3u);
    for (const auto &said : found)
    {
        EXPECT_EQ(said.Peer, Sender);
        EXPECT_EQ(said.Reader, UserReader);
        EXPECT_EQ(said.Writer, UserWriter);
    }
    EXPECT_EQ(found[0].Base, 4);
    EXPECT_FALSE(found[0].Asks);
    EXPECT_TRUE(found[1].Asks);
    EXPECT_EQ(found[2].Base, 0);
    EXPECT_TRUE(found[2].Asks);
}

}  // namespace
