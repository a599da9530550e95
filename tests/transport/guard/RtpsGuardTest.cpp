// Which parts of a datagram get through to the vendor's parser.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "guard/Gate.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::Rtps::LivelinessWriter;
using Rabit::Rtps::ParticipantEntity;
using Rabit::Rtps::ParticipantWriter;
using Rabit::Rtps::PublicationsWriter;
using Rabit::Rtps::RtpsGuard;
using Rabit::Rtps::WalkBudget;
using RtpsBytes::Gate;

// A guard that knows the sender and one of its writers, announced and at number 10.
class RtpsGuardTest : public testing::Test
{
protected:
    RtpsGuardTest()
    {
        EXPECT_TRUE(Guard.Passes(ParticipantMessage()));
        EXPECT_TRUE(Guard.Passes(WriterMessage()));
        EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(10), 5)));
    }

    static Bytes Goodbye()
    {
        return Message(Data,
                       DataBody(2,
                                Join({Parameter(0x0070, Guid(Sender, 0x000001c1)),
                                      Parameter(0x0071, {0, 0, 0, 3}),
                                      {1, 0, 0, 0}}),
                                0x000100c2),
                       3);
    }

    Gate Guard;
};

TEST_F(RtpsGuardTest, WhoAnnouncesItselfAgainBeforeItHasSaidAnythingToUsIsAnswered)
{
    Guard.Sending(Join({Header(Other), Submessage(Data, DataBody(1), 5)}));
    EXPECT_FALSE(Guard.TakeReplyDue());
    EXPECT_TRUE(Guard.Passes(ParticipantMessage()));
    EXPECT_TRUE(Guard.TakeReplyDue());
    EXPECT_FALSE(Guard.TakeReplyDue());
    // The peer sends to another participant.
    Guard.Now += 1s;
    const GuidPrefix third = {1, 15, 9};
    Guard.Admit(Join({Header(), Submessage(InfoDestination, Bytes(third.begin(), third.end())),
                      Submessage(Data, DataBody(11), 5)}));
    EXPECT_TRUE(Guard.Passes(ParticipantMessage()));
    EXPECT_TRUE(Guard.TakeReplyDue());
    // The peer sends to us.
    Guard.Now += 1s;
    Guard.Admit(Join({Header(), Submessage(InfoDestination, Bytes(Other.begin(), Other.end())),
                      Submessage(Data, DataBody(12), 5)}));
    EXPECT_TRUE(Guard.Passes(ParticipantMessage()));
    EXPECT_FALSE(Guard.TakeReplyDue());
}

TEST_F(RtpsGuardTest, WhatIsForAnotherParticipantIsKeptFromTheVendor)
{
    Guard.Sending(Join({Header(Other), Submessage(Data, DataBody(1), 5)}));
    const GuidPrefix third = {1, 15, 9};
    const Bytes forUs = Join(
        {Submessage(InfoDestination, Bytes(Other.begin(), Other.end())), Submessage(Data, DataBody(11), 5)});
    const Bytes toThird = Submessage(InfoDestination, Bytes(third.begin(), third.end()));
    const Bytes forThird = Submessage(Heartbeat, HeartbeatBody(1, 12, 1));
    EXPECT_TRUE(Guard.Admit(Join({Header(), forUs, toThird, forThird})));
    ASSERT_EQ(Guard.Handed.size(), 1u);
    Bytes left = Join({Header(), forUs, toThird});
    left.resize(left.size() + forThird.size());
    constexpr std::uint8_t pad = 0x01;
    left[left.size() - forThird.size()] = pad;
    ASSERT_EQ(Guard.Handed[0].size(), left.size());
    EXPECT_EQ(Guard.Handed[0][left.size() - forThird.size()], pad);
    EXPECT_TRUE(std::equal(left.begin(), left.end() - static_cast<std::ptrdiff_t>(forThird.size()),
                           Guard.Handed[0].begin()));
    EXPECT_TRUE(Guard.Admit(Join({Header(), toThird, forThird})));
    EXPECT_TRUE(Guard.Handed.empty());
}

TEST_F(RtpsGuardTest, TheByteWithWhichCycloneDdsEndsIsDroppedInSilence)
{
    EXPECT_TRUE(Guard.Admit({0}));
    EXPECT_TRUE(Guard.Handed.empty());
    EXPECT_TRUE(Guard.Stops({1}));
    EXPECT_TRUE(Guard.Stops({0, 0}));
}

TEST_F(RtpsGuardTest, OtherProtocolsAreStopped)
{
    Bytes message = Message(Data, DataBody(11), 5);
    message[0] = 'X';
    EXPECT_TRUE(Guard.Stops(message));
    message = Message(Data, DataBody(11), 5);
    message[4] = 9;  // protocol version 9
    EXPECT_TRUE(Guard.Stops(message));
    EXPECT_TRUE(Guard.Stops({}));
    EXPECT_TRUE(Guard.Stops(Join({Header(GuidPrefix{}), Submessage(Data, DataBody(11), 5)})));
}

// The original datagram: 52 bytes that made the vendor take 2.3 GB in 8 seconds.
TEST_F(RtpsGuardTest, AGapOfBillionsFromAKnownWriterIsStopped)
{
    const Bytes gap = Message(Gap, GapBody(12, std::int64_t{1} << 32));
    EXPECT_EQ(gap.size(), 52u);
    EXPECT_TRUE(Guard.Stops(gap));
}

TEST_F(RtpsGuardTest, AGapFarBeyondWhatTheWriterWroteIsStopped)
{
    EXPECT_TRUE(Guard.Passes(Message(Gap, GapBody(11, 13))));
    EXPECT_TRUE(Guard.Stops(Message(Gap, GapBody(11, 300))));
    EXPECT_TRUE(Guard.Stops(Message(Gap, GapBody(11, 20, 256))));
    // Time alone does not advance a writer.
    Guard.Now += 1h;
    EXPECT_TRUE(Guard.Stops(Message(Gap, GapBody(11, 300))));
}

// A late reader of a keyed topic may lack millions of samples between the last of one key and that of the
// next. Without any gap for them it would wait for ever; the rest of a narrowed one it requests.
TEST_F(RtpsGuardTest, AnHonestGapThatIsTooWideIsNarrowed)
{
    constexpr std::int64_t million = 1 << 20;
    EXPECT_TRUE(Guard.Passes(ParticipantMessage(Other)));
    EXPECT_TRUE(Guard.Passes(WriterMessage(UserWriter, 1, Other)));
    for (std::uint32_t i = 0; i < 8; ++i)  // so many agree
    {
        Guard.Admit(Join({Header(Other), Submessage(Heartbeat, HeartbeatBody(1, 9 * million, i))}));
    }
    // The vendor has the first sample.
    Guard.Sending(Join({Header(), Submessage(InfoDestination, Bytes(Other.begin(), Other.end())),
                        Submessage(AckNack, AckNackBody(2, 64, 1))}));
    const auto gap = [](std::int64_t first, std::int64_t base, const Bytes &bits)
    {
        return Join({Header(Other),
                     Submessage(Gap, Join({Ids(), Sequence(first), Sequence(base), bits, Bytes(8, 0xff)}))});
    };
    EXPECT_TRUE(Guard.Passes(gap(2, 2 + million, U32(64))));
    EXPECT_TRUE(Guard.Admit(gap(2, 9 * million - 64, U32(64))));
    constexpr std::int64_t Reached = 2 + WalkBudget::Burst + 2 * WalkBudget::Free;
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{gap(2 + million, Reached, U32(0))});
}

// The assertion at RTPSStatisticsMessages.hpp:128: the vendor rounds the length of a submessage up and finds
// statistics where none are, or finds them in front of something else.
TEST_F(RtpsGuardTest, StatisticsNeverGetThrough)
{
    const Bytes data = Message(Data, DataBody(11), 5);
    const Bytes statistics = Submessage(Statistics, Bytes(56));
    EXPECT_TRUE(Guard.Admit(Join({data, statistics})));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{data});
    EXPECT_TRUE(Guard.Stops(Join({data, statistics, statistics})));
    EXPECT_TRUE(Guard.Stops(Join({Header(), statistics, Submessage(Data, DataBody(11), 5)})));
}

TEST_F(RtpsGuardTest, ASubmessageOfAnOddLengthBeforeAnotherOneIsStopped)
{
    const Bytes odd = DataBody(11, {0, 1, 0, 0, 7});
    EXPECT_TRUE(Guard.Passes(Message(Data, odd, 5)));
    EXPECT_TRUE(Guard.Stops(Join({Message(Data, odd, 5), Submessage(Data, DataBody(12), 5)})));
}

// The assertion at PDP.cpp:1140.
TEST_F(RtpsGuardTest, AParticipantWithAnotherNameInItsDataIsStopped)
{
    const Bytes data = ParticipantData(Other);
    EXPECT_TRUE(Guard.Stops(Message(Data, DataBody(1, data, 0x000100c2), 5)));
}

// A goodbye overtakes announcements that were sent before it on another socket.
TEST_F(RtpsGuardTest, AnAnnouncementBehindAGoodbyeIsKeptFromTheVendor)
{
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Admit(Goodbye()));
    Guard.Now += 1900ms;
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Handed.empty());
}

TEST_F(RtpsGuardTest, AParticipantThatGoesOnAfterAForgedGoodbyeIsHeardAgain)
{
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Admit(Goodbye()));
    Guard.Now += 1900ms;
    EXPECT_TRUE(Guard.Admit(Goodbye()));
    Guard.Now += 100ms;
    EXPECT_TRUE(Guard.Admit(Message(Data, DataBody(10), 5)));
    Guard.Now += Rabit::Rtps::RecentGoodbyes::GoesOn;
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
}

TEST_F(RtpsGuardTest, AnAnnouncementThatWasHeldUpForLongBehindAGoodbyeBringsNobodyBack)
{
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Admit(Goodbye()));
    Guard.Now += 10s;
    // All that waited in the queue comes together.
    for (int i = 0; i < 10; ++i)
    {
        Guard.Now += 100ms;
        EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
        EXPECT_TRUE(Guard.Handed.empty());
    }
}

// Cyclone DDS writes what it ends into the payload alone, and Fast DDS reads it in the inline QoS alone.
class EndByItsPayload : public RtpsGuardTest
{
protected:
    static constexpr std::uint8_t HasInlineQosAndKey = 1 | 2 | 8;

    static Bytes End(EntityId writer, const Bytes &guid, const Bytes &keyHash = {})
    {
        const std::uint16_t key = writer == ParticipantWriter ? 0x0050 : 0x005a;
        return DataBody(
            2, Join({keyHash, Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}, List({Parameter(key, guid)})}),
            writer);
    }
    static Bytes Without(EntityId writer, const Bytes &guid)
    {
        return Message(Data, End(writer, guid), HasInlineQosAndKey);
    }
    static Bytes With(EntityId writer, const Bytes &guid, const GuidPrefix &to = {})
    {
        return Join({Header(), Submessage(InfoDestination, Bytes(to.begin(), to.end())),
                     Submessage(Data, End(writer, guid, Parameter(0x0070, guid)), HasInlineQosAndKey)});
    }
};

TEST_F(EndByItsPayload, OfAParticipantGetsAKeyHash)
{
    const Bytes guid = Guid(Sender, ParticipantEntity);
    EXPECT_TRUE(Guard.Admit(Without(ParticipantWriter, guid)));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{With(ParticipantWriter, guid)});
}

TEST_F(EndByItsPayload, OfAnEndpointGetsAKeyHash)
{
    const Bytes guid = Guid(Sender, UserWriter);
    EXPECT_TRUE(Guard.Admit(Without(PublicationsWriter, guid)));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{With(PublicationsWriter, guid)});
}

TEST_F(EndByItsPayload, InADatagramWithOthersGetsAKeyHashAndKeepsItsDestination)
{
    Guard.Sending(Join({Header(Other), Submessage(Data, DataBody(1), 5)}));
    const Bytes guid = Guid(Sender, UserWriter);
    const Bytes destination = Submessage(InfoDestination, Bytes(Other.begin(), Other.end()));
    EXPECT_TRUE(Guard.Admit(
        Join({Header(), destination, Submessage(Data, End(PublicationsWriter, guid), HasInlineQosAndKey),
              Submessage(Heartbeat, HeartbeatBody(1, 2, 1, PublicationsWriter))})));
    ASSERT_EQ(Guard.Handed.size(), 2u);
    EXPECT_EQ(Guard.Handed[0], With(PublicationsWriter, guid, Other));
}

TEST_F(EndByItsPayload, BigEndianGetsAKeyHash)
{
    const Bytes guid = Guid(Sender, ParticipantEntity);
    const auto whole = [&](std::uint8_t size, const Bytes &keyHash)
    {
        return Join({{Data, 2 | 8, 0, size, 0, 0, 0, 16},
                     Ids(0, ParticipantWriter),
                     {0, 0, 0, 0, 0, 0, 0, 2},
                     keyHash,
                     {0, 0x71, 0, 4, 0, 0, 0, 3, 0, 1, 0, 0},
                     {0, 2, 0, 0, 0, 0x50, 0, 16},
                     guid,
                     {0, 1, 0, 0}});
    };
    EXPECT_TRUE(Guard.Admit(Join({Header(), whole(60, {})})));
    const Bytes to = Submessage(InfoDestination, Bytes(GuidPrefix{}.size()));
    EXPECT_EQ(Guard.Handed,
              std::vector<Bytes>{Join({Header(), to, whole(80, Join({{0, 0x70, 0, 16}, guid}))})});
}

TEST_F(EndByItsPayload, OfAnotherOneIsStopped)
{
    EXPECT_TRUE(Guard.Stops(Without(ParticipantWriter, Guid(Other, ParticipantEntity))));
    EXPECT_TRUE(Guard.Stops(Without(PublicationsWriter, Guid(Other, UserWriter))));
}

// As an end with a key hash (ElsewhereTest).
TEST_F(EndByItsPayload, FromElsewhereIsBelievedTheThirdTime)
{
    Guard.From = {10, 0, 0, 9};
    const Bytes end = Without(ParticipantWriter, Guid(Sender, ParticipantEntity));
    EXPECT_TRUE(Guard.Stops(end));
    EXPECT_TRUE(Guard.Stops(end));
    EXPECT_TRUE(Guard.Admit(end));
    EXPECT_EQ(Guard.Handed.size(), 1u);
}

TEST_F(EndByItsPayload, IsUnchangedForCycloneDds)
{
    Gate guard(RtpsGuard::Mode::Full, RtpsGuard::Vendor::CycloneDds);
    EXPECT_TRUE(guard.Passes(ParticipantMessage()));
    EXPECT_TRUE(guard.Passes(Without(ParticipantWriter, Guid(Sender, ParticipantEntity))));
}

// A program that only listens says nothing else.
TEST_F(RtpsGuardTest, TwoAnnouncementsSomeTimeApartShowThatAGoodbyeWasForged)
{
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Admit(Goodbye()));
    Guard.Now += 10s;
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_TRUE(Guard.Handed.empty());
    Guard.Now += 10s;
    EXPECT_TRUE(Guard.Admit(ParticipantMessage()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
}

// The vendor reports a participant once: what the session drops never comes again.
TEST_F(RtpsGuardTest, ASessionThatSharesTheGoodbyesDropsNoAnnouncementThatWasLetThrough)
{
    const auto goodbyes = std::make_shared<Rabit::Rtps::RecentGoodbyes>();
    RtpsGuard guard(RtpsGuard::Mode::Full, 10s, RtpsGuard::Vendor::FastDds, goodbyes);
    auto now = Guard.Now;
    bool isHeard = false;
    const auto admit = [&](Bytes datagram)
    {
        isHeard = false;
        guard.Admit(datagram, SenderHost, now, [&](auto) { isHeard = true; });
    };
    admit(ParticipantMessage());
    admit(Goodbye());
    EXPECT_TRUE(goodbyes->Has(Sender, now));
    do
    {
        now += 100ms;
        admit(ParticipantMessage());
    } while (!isHeard);
    EXPECT_FALSE(goodbyes->Has(Sender, now));
}

// Anybody can send goodbyes.
TEST(RtpsGuardModes, GoodbyesOfParticipantsThatNeverWereDisplaceNoOther)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    const auto announcement = [](const GuidPrefix &who) {
        return Join({Header(who), Submessage(Data, DataBody(1, ParticipantData(who), ParticipantWriter), 5)});
    };
    const auto goodbye = [](const GuidPrefix &who)
    {
        return Join({Header(who), Submessage(Data,
                                             DataBody(2,
                                                      Join({Parameter(0x0070, Guid(who, ParticipantEntity)),
                                                            Parameter(0x0071, {0, 0, 0, 3}),
                                                            {1, 0, 0, 0}}),
                                                      ParticipantWriter),
                                             3)});
    };
    const auto forge = [&](std::uint8_t round)
    {
        GuidPrefix forged = Other;
        forged[0] = round;
        for (std::size_t i = 0; i < Rabit::Rtps::RecentGoodbyes::Most; ++i)
        {
            forged[10] = static_cast<std::uint8_t>(i / 256);
            forged[11] = static_cast<std::uint8_t>(i % 256);
            guard.Admit(goodbye(forged));
        }
    };
    EXPECT_TRUE(guard.Passes(announcement(Sender)));
    forge(1);
    EXPECT_TRUE(guard.Passes(goodbye(Sender)));
    forge(2);
    EXPECT_TRUE(guard.Admit(announcement(Sender)));
    EXPECT_TRUE(guard.Handed.empty());
}

TEST_F(RtpsGuardTest, ADisposalOfAnotherOnesThingsIsStopped)
{
    const auto goodbye = [](const Bytes &key)
    {
        return Message(
            Data,
            DataBody(2, Join({Parameter(0x0070, key), Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}}),
                     0x000100c2),
            3);
    };
    EXPECT_TRUE(Guard.Passes(goodbye(Guid(Sender, 0x000001c1))));
    EXPECT_TRUE(Guard.Stops(goodbye(Guid(Other, 0x000001c1))));
}

// Key payloads: a list of parameters, as both vendors send them.
TEST_F(RtpsGuardTest, ADisposalOfAnotherOnesThingsByTheKeyInThePayloadIsStopped)
{
    const auto goodbye = [](const Bytes &payload, EntityId writer)
    {
        return Message(
            Data, DataBody(2, Join({Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}, payload}), writer), 0x0b);
    };
    const auto participant = [](const GuidPrefix &who)
    { return List({Parameter(0x0050, Guid(who, ParticipantEntity))}); };
    const auto endpoint = [](const GuidPrefix &who)
    { return List({Parameter(0x005a, Guid(who, UserWriter))}); };
    EXPECT_TRUE(Guard.Stops(goodbye(participant(Other), ParticipantWriter)));
    EXPECT_TRUE(Guard.Stops(goodbye(endpoint(Other), PublicationsWriter)));
    EXPECT_TRUE(Guard.Stops(goodbye(List({}), ParticipantWriter)));
    EXPECT_TRUE(Guard.Admit(goodbye(endpoint(Sender), PublicationsWriter)));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_TRUE(Guard.Admit(goodbye(participant(Sender), ParticipantWriter)));
    EXPECT_EQ(Guard.Handed.size(), 1u);
}

// The vendor reads a whole key of 16 bytes behind the encapsulation, present or not.
TEST_F(RtpsGuardTest, AKeyOfLivelinessIsWhole)
{
    const auto gone = [](const Bytes &payload)
    {
        return Message(
            Data,
            DataBody(2, Join({Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}, payload}), LivelinessWriter),
            0x0b);
    };
    const Bytes key = Join({{0, 1, 0, 0}, Guid(Sender, 0)});
    EXPECT_TRUE(Guard.Passes(gone(key)));
    for (std::size_t size = 4; size < key.size(); ++size)
    {
        EXPECT_TRUE(Guard.Stops(gone(Bytes(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(size)))))
            << size;
    }
    EXPECT_TRUE(Guard.Stops(gone(Join({{0, 3, 0, 0}, Guid(Sender, 0)}))));
    EXPECT_TRUE(Guard.Stops(gone(Join({{0, 1, 0, 0}, Guid(Other, 0)}))));
}

// Cyclone DDS puts messages of several participants of a process into one datagram.
TEST_F(RtpsGuardTest, OneDatagramMaySpeakForSeveralParticipants)
{
    const Bytes data = Submessage(Data, DataBody(11), 5);
    EXPECT_TRUE(Guard.Passes(ParticipantMessage(Other)));
    EXPECT_TRUE(Guard.Passes(WriterMessage(UserWriter, 1, Other)));
    EXPECT_TRUE(Guard.Passes(Join({Header(Other), data, Source(Sender), data})));
    // Each participant has its own numbers: the sender was at 10, the other one is at 11 now.
    const Bytes ahead = Submessage(Data, DataBody(27), 5);
    EXPECT_TRUE(Guard.Stops(Join({Header(Sender), Source(Other), Submessage(Data, DataBody(28), 5)})));
    EXPECT_TRUE(Guard.Passes(Join({Header(Sender), Source(Other), ahead})));
}

TEST_F(RtpsGuardTest, WhoIsSpokenForIsWhoTheAnnouncementIsAbout)
{
    const auto announced = [](const GuidPrefix &who)
    { return Submessage(Data, DataBody(1, ParticipantData(who), 0x000100c2), 5); };
    EXPECT_TRUE(Guard.Passes(Join({Header(Sender), announced(Sender), Source(Other), announced(Other)})));
    EXPECT_TRUE(Guard.Stops(Join({Header(Other), Source(Sender), announced(Other)})));
    EXPECT_TRUE(Guard.Passes(WriterMessage(UserWriter, 1, Other)));
}

TEST_F(RtpsGuardTest, WhoSpeaksForNobodyIsStopped)
{
    const Bytes data = Submessage(Data, DataBody(11), 5);
    EXPECT_TRUE(Guard.Stops(Join({Header(), Source(GuidPrefix{}), data})));
    Bytes version = Source(Sender);
    version[8] = 9;
    EXPECT_TRUE(Guard.Stops(Join({Header(), version, data})));
    for (const std::size_t size : {16u, 24u})
    {
        EXPECT_TRUE(Guard.Stops(Join({Message(InfoSource, Bytes(size, 2)), data}))) << size;
    }
    EXPECT_TRUE(Guard.Passes(Join({Header(), Source(Sender), data})));
}

// Later versions of the protocol have them, and a receiver skips them (8.3.4.1): 0x00 is HEADER_EXTENSION of
// RTPS 2.5.
TEST_F(RtpsGuardTest, ASubmessageOfAnUnknownKindCostsNothingElse)
{
    for (const std::uint8_t kind : Bytes{0x00, 0x0d, 0x20, 0x36, 0x7f})
    {
        EXPECT_TRUE(Guard.Admit(Join({Message(kind, Bytes(32, 7)), Submessage(Data, DataBody(11), 5)})));
        EXPECT_EQ(Guard.Handed,
                  std::vector<Bytes>{Join({Message(0x01, Bytes(32, 7)), Submessage(Data, DataBody(11), 5)})})
            << int{kind};
    }
}

TEST_F(RtpsGuardTest, OtherAddressesForAnswersAreKeptFromTheVendor)
{
    const Bytes data = Submessage(Data, DataBody(11), 5);
    EXPECT_TRUE(Guard.Admit(Join({Message(InfoReply, Bytes(28)), data})));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{Join({Message(0x01, Bytes(28)), data})});
}

TEST_F(RtpsGuardTest, WhatOtherVendorsAddIsBlanked)
{
    const Bytes data = Submessage(Data, DataBody(11), 5);
    EXPECT_TRUE(Guard.Admit(Join({Message(0x81, {1, 2, 3, 4}), data})));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{Join({Message(0x01, {1, 2, 3, 4}), data})});
}

TEST_F(RtpsGuardTest, BuiltinTopicsThatWeDoNotHaveAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(Message(Data, DataBody(1, Bytes(8), 0x000300c3), 5)));
    EXPECT_TRUE(Guard.Handed.empty());
}

TEST_F(RtpsGuardTest, StrangersAreNotHeardBeforeTheyAnnounceThemselves)
{
    const Bytes data = Join({Header(Other), Submessage(Data, DataBody(1), 5)});
    EXPECT_TRUE(Guard.Admit(data));
    EXPECT_TRUE(Guard.Handed.empty());
    EXPECT_TRUE(Guard.Passes(ParticipantMessage(Other)));
    EXPECT_TRUE(Guard.Admit(data));
    EXPECT_TRUE(Guard.Handed.empty());
    EXPECT_TRUE(Guard.Passes(WriterMessage(UserWriter, 1, Other)));
    EXPECT_TRUE(Guard.Passes(data));
}

TEST_F(RtpsGuardTest, APeerThatIsHeardCannotBeSentElsewhere)
{
    EXPECT_TRUE(Guard.Passes(ParticipantMessage(Sender, 7410)));
    EXPECT_TRUE(Guard.Stops(ParticipantMessage(Sender, 9999)));
}

// The vendor ignores a participant's announcement under a number that it has seen.
TEST_F(RtpsGuardTest, APeerThatWasForgedFirstIsNewsWhenItIsBelieved)
{
    const auto honest = [](std::int64_t number)
    {
        return Join(
            {Header(Other), Submessage(Data, DataBody(number, ParticipantData(Other, 7410), 0x000100c2), 5)});
    };
    EXPECT_TRUE(Guard.Passes(ParticipantMessage(Other, 9999)));
    for (int i = 0; i < 2; ++i)
    {
        Guard.Now += 1s;
        EXPECT_TRUE(Guard.Stops(honest(1)));
    }
    for (int i = 0; i < 2; ++i)
    {
        Guard.Now += 1s;
        EXPECT_TRUE(Guard.Admit(honest(1)));
        EXPECT_EQ(Guard.Handed, std::vector<Bytes>{honest(2)});
    }
    // The participant's later announcements get higher numbers too, and so does its goodbye.
    EXPECT_TRUE(Guard.Admit(honest(2)));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{honest(3)});
    const auto goodbye = [](std::int64_t number)
    {
        return Join({Header(Other), Submessage(Data,
                                               DataBody(number,
                                                        Join({Parameter(0x0070, Guid(Other, 0x000001c1)),
                                                              Parameter(0x0071, {0, 0, 0, 3}),
                                                              {1, 0, 0, 0}}),
                                                        0x000100c2),
                                               3)});
    };
    EXPECT_TRUE(Guard.Admit(goodbye(3)));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{goodbye(4)});
}

// The announcement has the next number of the topic of writers, and moves a writer to another topic. The
// writer's readers here would lose it for good.
TEST_F(RtpsGuardTest, AnEndpointThatIsKnownCannotBeChangedByOneAnnouncement)
{
    Bytes changed = WriterMessage(UserWriter, 2);
    const Bytes name = {'P', 'o', 's', 'e'};
    std::search(changed.begin(), changed.end(), name.begin(), name.end())[3] = 'f';
    EXPECT_TRUE(Guard.Stops(changed));
    EXPECT_TRUE(Guard.Passes(WriterMessage(UserWriter, 2)));
    // The writer's owner retransmits the announcement until it gets through.
    EXPECT_TRUE(Guard.Stops(changed));
    EXPECT_TRUE(Guard.Stops(changed));
    EXPECT_TRUE(Guard.Passes(changed));
}

TEST_F(RtpsGuardTest, AWriterThatJumpsIsStoppedAndOneThatGoesOnIsNot)
{
    EXPECT_TRUE(Guard.Stops(Message(Data, DataBody(100'000), 5)));
    EXPECT_TRUE(Guard.Stops(Message(Heartbeat, HeartbeatBody(1, 100'000, 1))));
    EXPECT_TRUE(Guard.Stops(Message(Heartbeat, HeartbeatBody(100'001, 100'000, 1))));
    EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(11), 5)));
    EXPECT_TRUE(Guard.Admit(Message(Heartbeat, HeartbeatBody(12, 11, 1))));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    Guard.Now += 10s;
    EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(10'000), 5)));
}

// Unchanged, one forged heartbeat with the highest count would silence all honest ones after it.
TEST_F(RtpsGuardTest, AForgedCountDoesNotSilenceTheHonestHeartbeats)
{
    const auto countOf = [this](std::uint8_t kind, const Bytes &body)
    {
        EXPECT_TRUE(Guard.Admit(Message(kind, body)));
        const Bytes &handed = Guard.Handed.at(0);
        const auto *count = &handed[handed.size() - 4];
        return std::uint32_t{count[0]} | std::uint32_t{count[1]} << 8 | std::uint32_t{count[2]} << 16;
    };
    const auto first = countOf(Heartbeat, HeartbeatBody(1, 10, 1));
    EXPECT_EQ(countOf(Heartbeat, HeartbeatBody(1, 10, 0xffffffff)), first + 1);
    EXPECT_EQ(countOf(Heartbeat, HeartbeatBody(1, 10, 2)), first + 2);
}

// For such a request, the vendor would read past the end of the sample.
TEST_F(RtpsGuardTest, FragmentsThatAreNotThereCannotBeAskedFor)
{
    EXPECT_TRUE(Guard.Stops(Message(NackFrag, NackFragBody(1, 1, 1, 1))));
    Guard.Sending(Message(DataFrag, FragmentBody(1, 1, 1000, 2500, 1000)));
    EXPECT_TRUE(Guard.Admit(Message(NackFrag, NackFragBody(1, 1, 3, 1))));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_TRUE(Guard.Stops(Message(NackFrag, NackFragBody(1, 1, 4, 2))));
    EXPECT_TRUE(Guard.Stops(Message(NackFrag, NackFragBody(1, 5, 1, 3))));
}

TEST(RtpsGuard, WhoIsNotToldOfWhatIsSentLetsRequestsForFragmentsPass)
{
    Gate gate(RtpsGuard::Mode::Full, RtpsGuard::Vendor::CycloneDds);
    EXPECT_TRUE(gate.Passes(ParticipantMessage()));
    EXPECT_TRUE(gate.Passes(Message(NackFrag, NackFragBody(1, 1, 1, 1))));
}

// A stopped submessage does not stop the others of its datagram.
TEST_F(RtpsGuardTest, WhatIsRefusedIsBlankedAndTheRestGetsThrough)
{
    const Bytes data = Submessage(Data, DataBody(11), 5);
    EXPECT_FALSE(Guard.Admit(Join({Message(Gap, GapBody(11, 900)), data})));
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{Join({Message(0x01, GapBody(11, 900)), data})});
}

std::vector<Bytes> Cut(const Bytes &payload, std::uint16_t size, const Bytes &header = Header(),
                       EntityId writer = 0x000003c2)
{
    std::vector<Bytes> fragments;
    for (std::size_t at = 0; at < payload.size(); at += size)
    {
        const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(at);
        const Bytes piece(
            begin, begin + static_cast<std::ptrdiff_t>(std::min<std::size_t>(size, payload.size() - at)));
        fragments.push_back(
            Join({header, Submessage(DataFrag, Join({{0, 0, 28, 0},
                                                     Ids(0, writer),
                                                     Sequence(2),
                                                     U32(static_cast<std::uint32_t>(at / size + 1)),
                                                     U16(1),
                                                     U16(size),
                                                     U32(static_cast<std::uint32_t>(payload.size())),
                                                     piece}))}));
    }
    return fragments;
}

TEST_F(RtpsGuardTest, AnAnnouncementInFragmentsGetsThroughWhole)
{
    auto fragments = Cut(WriterData(0x00000203), 64);
    ASSERT_GT(fragments.size(), 1u);
    std::reverse(fragments.begin(), fragments.end());
    for (std::size_t i = 0; i + 1 < fragments.size(); ++i)
    {
        EXPECT_TRUE(Guard.Admit(fragments[i]));
        EXPECT_TRUE(Guard.Handed.empty());
    }
    EXPECT_TRUE(Guard.Admit(fragments.back()));
    const Bytes whole = Join({Message(InfoDestination, Bytes(12)),
                              Submessage(Data, DataBody(2, WriterData(0x00000203), 0x000003c2), 5)});
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{whole});
    EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(1, Bytes(8), 0x00000203), 5)));
}

TEST_F(RtpsGuardTest, AnAnnouncementInFragmentsIsOfWhoIsSpokenFor)
{
    const auto fragments = Cut(WriterData(0x00000203), 64, Join({Header(Other), Source(Sender)}));
    for (const Bytes &fragment : fragments)
    {
        EXPECT_TRUE(Guard.Admit(fragment));
    }
    const Bytes whole = Join({Message(InfoDestination, Bytes(12)),
                              Submessage(Data, DataBody(2, WriterData(0x00000203), 0x000003c2), 5)});
    EXPECT_EQ(Guard.Handed, std::vector<Bytes>{whole});
}

TEST_F(RtpsGuardTest, AnUnsoundAnnouncementInFragmentsIsStopped)
{
    const auto fragments = Cut(WriterData(UserWriter, Other), 64);
    for (std::size_t i = 0; i + 1 < fragments.size(); ++i)
    {
        EXPECT_TRUE(Guard.Admit(fragments[i]));
    }
    EXPECT_TRUE(Guard.Stops(fragments.back()));
}

TEST(RtpsGuardModes, WhereSharedMemoryIsInUseOnlyTheStructureIsChecked)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    EXPECT_TRUE(guard.Passes(Message(Data, DataBody(10), 5)));
    EXPECT_TRUE(guard.Passes(Message(Heartbeat, HeartbeatBody(1, 1'000'000, 7))));
    EXPECT_TRUE(guard.Admit(Message(Gap, GapBody(1, std::int64_t{1} << 32))));
    EXPECT_EQ(guard.Handed,
              std::vector<Bytes>{Message(Gap, GapBody(1, 1 + WalkBudget::Burst + WalkBudget::Free))});
    EXPECT_TRUE(guard.Stops(Message(Data, DataBody(1, ParticipantData(Other), 0x000100c2), 5)));
    EXPECT_TRUE(guard.Admit(Message(Data, DataBody(1, Bytes(8), 0x000300c3), 5)));
    EXPECT_TRUE(guard.Handed.empty());
}

TEST(RtpsGuardModes, WhereOnlyTheStructureIsCheckedThereAreNotEndlesslyManyParticipantsEither)
{
    constexpr int most = 1024;
    const auto announced = [](int number)
    {
        GuidPrefix who = Sender;
        who[10] = static_cast<std::uint8_t>(number >> 8);
        who[11] = static_cast<std::uint8_t>(number);
        return ParticipantMessage(who);
    };
    Gate guard(RtpsGuard::Mode::StructureOnly);
    for (int i = 0; i < most; ++i)
    {
        EXPECT_TRUE(guard.Passes(announced(i)));
    }
    EXPECT_TRUE(guard.Stops(announced(most)));
    guard.Now += 61s;
    EXPECT_TRUE(guard.Passes(announced(0)));
    // A silent one gives its place away.
    EXPECT_TRUE(guard.Admit(announced(most)));
    EXPECT_EQ(guard.Handed.size(), 1u);
}

TEST(RtpsGuardModes, WhereOnlyTheStructureIsCheckedAParticipantIsHeardWhateverItSends)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    EXPECT_TRUE(guard.Passes(ParticipantMessage()));
    for (int i = 0; i < 1023; ++i)
    {
        GuidPrefix who = Other;
        who[9] = static_cast<std::uint8_t>(i >> 8);
        who[10] = static_cast<std::uint8_t>(i);
        EXPECT_TRUE(guard.Passes(ParticipantMessage(who)));
    }
    guard.Now += 61s;
    EXPECT_TRUE(guard.Passes(Message(Data, DataBody(1), 5)));
    // The places of the silent ones are given away first.
    for (int i = 0; i < 1023; ++i)
    {
        GuidPrefix who = Other;
        who[8] = 0;
        who[9] = static_cast<std::uint8_t>(i >> 8);
        who[10] = static_cast<std::uint8_t>(i);
        EXPECT_TRUE(guard.Passes(ParticipantMessage(who)));
    }
    EXPECT_TRUE(guard.Passes(ParticipantMessage()));
    EXPECT_TRUE(guard.Stops(ParticipantMessage({1, 15, 9})));
}

TEST(RtpsGuardModes, ADatagramThatSaysNothingKeepsNoPlaceForAParticipant)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    EXPECT_TRUE(guard.Passes(ParticipantMessage()));
    guard.Now += 61s;
    static_cast<void>(guard.Passes(Join({Header()})));
    for (int i = 0; i < 1024; ++i)
    {
        GuidPrefix who = Other;
        who[9] = static_cast<std::uint8_t>(i >> 8);
        who[10] = static_cast<std::uint8_t>(i);
        EXPECT_TRUE(guard.Passes(ParticipantMessage(who))) << i;
    }
}

// Nodes do not use DDS Security, so that the vendors' parsers of it need not be trusted.
TEST(RtpsGuardModes, SubmessagesAndTokensOfDdsSecurityReachNoParser)
{
    constexpr std::uint8_t messagePrefix = 0x33;
    constexpr std::uint8_t secureBody = 0x30;
    constexpr std::uint16_t identityToken = 0x1001;
    constexpr EntityId handshakeWriter = 0x000201c3;
    Bytes token = ParticipantData();
    token.resize(token.size() - 4);
    token = Join({token, Parameter(identityToken, Bytes(64, 7)), {1, 0, 0, 0}});
    for (const auto mode : {RtpsGuard::Mode::Full, RtpsGuard::Mode::StructureOnly})
    {
        Gate guard(mode);
        for (const std::uint8_t kind : {secureBody, SecurePrefix, messagePrefix})
        {
            EXPECT_TRUE(guard.Admit(Message(kind, Bytes(20))));
            EXPECT_TRUE(guard.Handed.empty());
        }
        EXPECT_TRUE(guard.Admit(Message(Data, DataBody(1, Bytes(8), handshakeWriter), 5)));
        EXPECT_TRUE(guard.Handed.empty());
        EXPECT_FALSE(guard.Admit(
            Join({Header(), Submessage(SecurePrefix, Bytes(20)), Submessage(Gap, GapBody(5, 3))})));
        EXPECT_TRUE(guard.Admit(Message(Data, DataBody(1, token, ParticipantWriter), 5)));
        ASSERT_EQ(guard.Handed.size(), 1u);
        const Bytes name = RtpsBytes::U16(identityToken);
        EXPECT_EQ(std::search(guard.Handed[0].begin(), guard.Handed[0].end(), name.begin(), name.end()),
                  guard.Handed[0].end());
    }
}

// With AddressSanitizer this tells whether anything outside of the datagram is read or written.
TEST_F(RtpsGuardTest, AnyBytesAreSafeToCheck)
{
    std::mt19937 random(1);
    std::vector<Bytes> seeds = {
        ParticipantMessage(),
        WriterMessage(),
        Message(Data, DataBody(11, Join({Parameter(0x0070, Bytes(16)), {1, 0, 0, 0}, Bytes(8)})), 7),
        Message(DataFrag, FragmentBody(1, 1, 64, 250, 64)),
        Message(AckNack, AckNackBody(1, 64, 1)),
        Message(NackFrag, NackFragBody(1, 1, 64, 1)),
        Message(Gap, GapBody(3, 5, 32)),
        Join({Header(), Source(Other), Submessage(AckNack, AckNackBody(1, 64, 1))}),
        Join({Message(InfoDestination, Bytes(12)), Submessage(Heartbeat, HeartbeatBody(1, 10, 1)),
              Submessage(Statistics, Bytes(56))})};
    const auto fragments = Cut(WriterData(), 64);
    seeds.insert(seeds.end(), fragments.begin(), fragments.end());
    int handed = 0;
    for (int i = 0; i < 300000; ++i)
    {
        Bytes bytes = seeds[random() % seeds.size()];
        for (auto changes = random() % 4; changes > 0; --changes)
        {
            bytes[20 + random() % (bytes.size() - 20)] = static_cast<std::uint8_t>(random());
        }
        bytes.resize(bytes.size() - random() % 3);
        bytes.shrink_to_fit();
        Guard.Admit(bytes);
        handed += Guard.Handed.empty() ? 0 : 1;
    }
    EXPECT_GT(handed, 0);
    EXPECT_LT(handed, 300000);
}

TEST(RtpsMessage, HasASizeWithoutItsStatisticsWhateverIsInFrontOfThem)
{
    const Bytes data = Message(Data, DataBody(11, Bytes(80)), 5);
    const Bytes statistics = Submessage(Statistics, Bytes(56));
    EXPECT_EQ(Rabit::Rtps::SizeWithoutStatistics(Join({data, statistics})), data.size());
    EXPECT_EQ(Rabit::Rtps::SizeWithoutStatistics(data), data.size());
    Bytes mistaken = data;
    mistaken[data.size() - 60] = Statistics;
    EXPECT_EQ(Rabit::Rtps::SizeWithoutStatistics(mistaken), mistaken.size());
    EXPECT_EQ(Rabit::Rtps::SizeWithoutStatistics(Join({mistaken, statistics})), mistaken.size());
}

}  // namespace
