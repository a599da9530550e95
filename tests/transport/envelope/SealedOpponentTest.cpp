// Members that lie, recordings, nodes with the same keys, and programs without keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>

#include "envelope/SealedFleet.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace SealedFleets;

bool HasRow(const SealedFleet &fleet, std::size_t index, const std::string &entry, const std::string &text)
{
    const auto rows = fleet.Nodes[index]->Keys->Problems();
    return std::any_of(rows.begin(), rows.end(),
                       [&](const Rabit::SettingsProblem &row)
                       { return row.Entry == entry && row.Text.find(text) != std::string::npos; });
}

// The session that the first recorded claim of that node introduces.
End EndOf(const SealedFleet &fleet, std::size_t index)
{
    const Hash hash = fleet.Nodes[index]->Keys->SelfIn({1}, {fleet.Nodes[index]->Vendor})->Own.Certificate;
    for (const Bytes &datagram : fleet.Recorded)
    {
        Outer outer;
        std::uint32_t high = 0;
        if (ReadOuter(datagram, outer) == OuterFault::None && outer.Kind == OuterKind::Claim &&
            ReadIntroduction(datagram, high).Certificate == hash)
        {
            return ReadIntroduction(datagram, high);
        }
    }
    throw std::logic_error("no claim was recorded");
}

// The third of three nodes that have met turns against the others.
class SealedMember : public testing::Test
{
protected:
    SealedMember() : Fleet(FleetOf(3)), Epochs(Fleet->Nodes[2]->Keys->Epochs())
    {
        Fleet->Records = true;
        Fleet->StartAll();
        Fleet->Run(3s);
        Fleet->Records = false;
    }
    // The third node with its own keys, in a session and with headers of its choice.
    Self Forger(const End &own, std::vector<RtpsHeader> headers) const
    {
        Self self = *Fleet->Nodes[2]->Keys->SelfIn(own.Session, std::move(headers));
        self.Own = own;
        return self;
    }
    // Each datagram is given to the first node for twelve seconds. Returns how many came out.
    std::size_t CameOut(const std::function<Bytes()> &datagram)
    {
        std::size_t cameOut = 0;
        for (int i = 0; i < 48; ++i)
        {
            cameOut += Fleet->Inject(0, datagram(), 2).empty() ? 0 : 1;
            Fleet->Run(250ms);
        }
        return cameOut;
    }

    std::unique_ptr<SealedFleet> Fleet;
    EpochSecrets Epochs;
};

TEST_F(SealedMember, CannotSpeakInAnothersSession)
{
    const RtpsHeader victim = Fleet->Nodes[1]->Vendor;
    Self self = Forger(EndOf(*Fleet, 1), {victim});
    self.Next = 1'000'000;
    Sealer sealer(self, Epochs);
    EXPECT_EQ(CameOut(
                  [&]
                  {
                      return SealNodes::Node::Taken(
                          [&](auto out)
                          { return sealer.SealGroup(MessageOf(victim), OuterClass::Traffic, out); });
                  }),
              0u);
    EXPECT_GE(Fleet->Nodes[0]->Core->Opened(OpenFault::BadSignature), 48u);
    EXPECT_TRUE(HasRow(*Fleet, 0, "10.0.0.3", "were made by another member"));
    EXPECT_TRUE(Fleet->IsOpen(0, 1));
}

TEST_F(SealedMember, CannotClaimAnothersParticipant)
{
    const RtpsHeader victim = Fleet->Nodes[1]->Vendor;
    Self self = Forger({.Session = SessionOf(9, 9), .Certificate = EndOf(*Fleet, 2).Certificate}, {victim});
    Sealer sealer(self, Epochs);
    const Bytes claim =
        SealNodes::Node::Taken([&](auto out) { return sealer.SealClaim({1}, {}, true, out); });
    Fleet->Inject(0, claim, 2);
    EXPECT_EQ(Fleet->Nodes[0]->Core->Opened(OpenFault::RefusedClaim), 1u);
    EXPECT_TRUE(HasRow(*Fleet, 0, "uav3", "uav3 claims an identity that uav2 has proven"));
    EXPECT_EQ(CameOut(
                  [&]
                  {
                      return SealNodes::Node::Taken(
                          [&](auto out)
                          { return sealer.SealGroup(MessageOf(victim), OuterClass::Traffic, out); });
                  }),
              0u);
    EXPECT_EQ(Fleet->Nodes[0]->Core->PeerOf(Fleet->PrefixOfNode(1))->Name, "uav2");
}

TEST_F(SealedMember, ThatClaimsAnothersParticipantAgainAndAgainIsLoggedOnce)
{
    Self self = Forger({.Session = SessionOf(9, 9), .Certificate = EndOf(*Fleet, 2).Certificate},
                       {Fleet->Nodes[1]->Vendor});
    Sealer sealer(self, Epochs);
    for (int i = 0; i < 20; ++i)
    {
        Fleet->Inject(
            0, SealNodes::Node::Taken([&](auto out) { return sealer.SealClaim({1}, {}, true, out); }), 2);
        Fleet->Run(100ms);
    }
    EXPECT_EQ(Fleet->Nodes[0]->Core->Opened(OpenFault::RefusedClaim), 20u);
    const auto &logs = Fleet->Nodes[0]->Logs;
    EXPECT_EQ(std::count_if(logs.begin(), logs.end(),
                            [](const std::string &line)
                            { return line.find("claims an identity") != std::string::npos; }),
              1);
}

TEST_F(SealedMember, CannotNameAnotherSource)
{
    // In its own session, which the others have proven.
    const RtpsHeader own = Fleet->Nodes[2]->Vendor;
    const Bytes source = RtpsBytes::Source(Fleet->PrefixOfNode(1));
    EXPECT_EQ(CameOut(
                  [&]
                  {
                      Bytes message(own.begin(), own.end());
                      message.insert(message.end(), source.begin(), source.end());
                      const Bytes data = MessageOf(own);
                      message.insert(message.end(), data.begin() + 20, data.end());
                      Bytes sealed;
                      Fleet->Nodes[2]->Core->Seal(message, std::nullopt, OuterClass::Traffic, sealed,
                                                  Fleet->Now);
                      return sealed;
                  }),
              0u);
    EXPECT_TRUE(HasRow(*Fleet, 0, "10.0.0.3", "in the name of other participants"));
}

TEST(SealedRecordings, OfAnHourAgoOpenNothingInAFreshNode)
{
    const auto fleet = FleetOf(4);
    fleet->Records = true;
    for (std::size_t index = 0; index < 3; ++index)
    {
        fleet->StartNode(index);
    }
    fleet->Run(10s);
    fleet->Records = false;
    for (std::size_t index = 0; index < 3; ++index)
    {
        fleet->Nodes[index]->Core.reset();
    }
    fleet->Jump(1h);
    fleet->StartNode(3);
    std::size_t cameOut = 0;
    for (int round = 0; round < 3; ++round)
    {
        for (const Bytes &datagram : fleet->Recorded)
        {
            cameOut += fleet->Inject(3, datagram).empty() ? 0 : 1;
            fleet->Run(20ms);
        }
    }
    EXPECT_EQ(cameOut, 0u);
    for (std::size_t index = 0; index < 3; ++index)
    {
        EXPECT_FALSE(fleet->Nodes[3]->Core->PeerOf(fleet->PrefixOfNode(index)));
    }
    // The nodes themselves are met as ever.
    for (std::size_t index = 0; index < 3; ++index)
    {
        fleet->StartNode(index);
    }
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 60s), 3s);
}

TEST(SealedRecordings, OfANodeThatIsSilentAreNoNews)
{
    const auto fleet = FleetOf(2, {.Beat = 100ms});
    fleet->StartAll();
    fleet->Run(5s);
    // A jammer keeps the datagrams of the second node.
    fleet->Hears = [](std::size_t from, std::size_t) { return from != 1; };
    fleet->Records = true;
    fleet->Run(5s);
    fleet->Records = false;
    fleet->Nodes[1]->Core.reset();
    fleet->Run(20s);
    std::size_t cameOut = 0;
    for (const Bytes &datagram : fleet->Recorded)
    {
        cameOut += fleet->Inject(0, datagram).empty() ? 0 : 1;
        fleet->Run(10ms);
    }
    EXPECT_EQ(cameOut, 0u);
}

TEST(SealedRecordings, OfManyClaimsTakeBoundedMemoryAndBoundedAnswers)
{
    const auto fleet = FleetOf(3);
    // A thousand sessions of one node, which nobody hears.
    fleet->Hears = [](std::size_t, std::size_t) { return false; };
    fleet->Records = true;
    for (int opening = 0; opening < 1000; ++opening)
    {
        fleet->StartNode(1);
        fleet->Run(1ms);
    }
    fleet->Records = false;
    fleet->Nodes[1]->Core.reset();
    fleet->Hears = [](std::size_t, std::size_t) { return true; };
    fleet->Jump(1h);
    fleet->StartNode(0);
    fleet->Run(1s);
    const std::size_t before = fleet->OwnBytesOf[0];
    const TimePoint since = fleet->Now;
    for (int round = 0; round < 10; ++round)
    {
        for (const Bytes &datagram : fleet->Recorded)
        {
            fleet->Inject(0, datagram);
            fleet->Run(1ms);
        }
    }
    const double seconds = std::chrono::duration<double>(fleet->Now - since).count();
    EXPECT_LE(static_cast<double>(fleet->OwnBytesOf[0] - before),
              SharedPace::MostOfOne * seconds + SharedPace::Burst + 2'000.0);
    EXPECT_LE(fleet->Nodes[0]->Core->Remembered().Sessions, SessionTable::MostUnprovenOfOne);
    EXPECT_LE(
        fleet->Nodes[0]->Core->Remembered().Others,
        2 * ClaimExchange::MostAsked + ClaimExchange::MostAnswered + ClaimExchange::MostRefused + 1'000);
    // A node that comes meanwhile is met.
    fleet->StartNode(2);
    EXPECT_LE(fleet->RunUntil([&] { return fleet->IsOpen(0, 2) && fleet->IsOpen(2, 0); }, 60s), 3s);
}

// Datagrams to strangers' hosts use up an allowance.
TEST(SealedRecordings, OfNodesThatAreKnownMakeNoHostAStranger)
{
    const auto fleet = FleetOf(2);
    fleet->Records = true;
    fleet->StartAll();
    fleet->Run(10s);
    fleet->Records = false;
    fleet->Run(5s);
    ASSERT_TRUE(fleet->AreAllOpen());
    ASSERT_TRUE(fleet->Nodes[0]->Core->Strangers(fleet->Now).empty());
    for (const Bytes &datagram : fleet->Recorded)
    {
        fleet->Inject(0, datagram);
    }
    EXPECT_TRUE(fleet->Nodes[0]->Core->Strangers(fleet->Now).empty());
}

TEST(SealedRecordings, OfInventedSessionsAreAnsweredSeldom)
{
    const auto fleet = FleetOf(1);
    fleet->StartAll();
    fleet->Run(20s);
    const std::size_t before = fleet->OwnBytes;
    Bytes datagram(100, 0);
    for (std::uint32_t number = 0; number < 30'000; ++number)
    {
        WriteOuter({.Kind = OuterKind::Group, .Epoch = 1, .Tag = 7 * number + 1, .Number = number}, datagram);
        fleet->Inject(0, datagram);
        fleet->Run(1ms);
    }
    // 30 s, in which 3 MB came.
    EXPECT_LE(fleet->OwnBytes - before, 25'000u);
    EXPECT_LE(fleet->Nodes[0]->Core->Remembered().Others, 2 * ClaimExchange::MostAsked);
}

TEST(SealedTwins, TwoNodesWithTheSameKeysAreARow)
{
    const auto fleet = FleetOf(2);
    const Bytes first = fleet->BulletinOf(1, {1, 2});
    fleet->Add("uav2", 2, {first});
    fleet->StartAll();
    fleet->Run(5s);
    EXPECT_FALSE(HasRow(*fleet, 0, "uav2", "live twice"));
    fleet->Run(20s);
    EXPECT_TRUE(HasRow(*fleet, 0, "uav2", "live twice"));
    fleet->Nodes[2]->Core.reset();
    fleet->Run(LastingProblems::PauseOf(ProblemKind::Usual) + 5s);
    EXPECT_FALSE(HasRow(*fleet, 0, "uav2", "live twice"));
}

TEST(SealedTwins, ANodeThatStartsAnewIsNone)
{
    const auto fleet = FleetOf(2, {.Beat = 100ms});
    fleet->StartAll();
    for (int i = 0; i < 30; ++i)
    {
        fleet->Run(1s);
        fleet->StartNode(1);
    }
    EXPECT_FALSE(HasRow(*fleet, 0, "uav2", "live twice"));
}

TEST(SealedStrangers, AProgramWithoutKeysIsNotHeardAndIsARow)
{
    const auto fleet = FleetOf(1);
    fleet->StartAll();
    for (int i = 0; i < 15; ++i)
    {
        EXPECT_TRUE(fleet->Inject(0, MessageOf(HeaderOf(9)), 8).empty());
        EXPECT_TRUE(fleet->Inject(0, Bytes{0}, 7).empty());
        EXPECT_TRUE(fleet->Inject(0, Bytes{}, 7).empty());
        fleet->Run(1s);
    }
    EXPECT_TRUE(HasRow(*fleet, 0, "10.0.0.9", "a program without keys sends there"));
    EXPECT_EQ(fleet->Nodes[0]->Keys->Problems().size(), 1u);
}

// `rabit doctor` calls as a participant of no vendor, and by a datagram in the epoch of calls.
Bytes SealedCall()
{
    const Outer outer{.Epoch = EpochOfCalls};
    Bytes call(OuterOverhead(outer.Kind));
    WriteOuter(outer, call);
    return call;
}

TEST(SealedStrangers, OfNoVendorOnlyLookWhoIsThere)
{
    const auto fleet = FleetOf(1);
    fleet->StartAll();
    RtpsHeader caller = HeaderOf(9, 0);
    caller[Prefix - 2] = 0;
    for (int i = 0; i < 15; ++i)
    {
        EXPECT_TRUE(fleet->Inject(0, MessageOf(caller), 8).empty());
        fleet->Run(1s);
    }
    EXPECT_TRUE(fleet->Nodes[0]->Keys->Problems().empty());
}

TEST(SealedCalls, AreAnsweredByOneClaimThatAsksNobody)
{
    const auto fleet = FleetOf(3);
    fleet->StartAll();
    fleet->Run(20s);
    ASSERT_TRUE(fleet->AreAllOpen());
    const auto before = fleet->OwnBytesOf;
    fleet->Inject(0, SealedCall());
    fleet->Run(3s);
    EXPECT_GT(fleet->OwnBytesOf[0], before.at(0));
    EXPECT_LE(fleet->OwnBytesOf[0] - before.at(0), 500u);
    EXPECT_EQ(fleet->OwnBytesOf[1], before.at(1));
    EXPECT_EQ(fleet->OwnBytesOf[2], before.at(2));
    EXPECT_TRUE(fleet->Nodes[0]->Core->Strangers(fleet->Now).empty());
}

TEST(SealedCalls, AreAnsweredOnceInASecondAndMakeNoRow)
{
    const auto fleet = FleetOf(2);
    fleet->StartAll();
    fleet->Run(20s);
    const auto before = fleet->OwnBytesOf;
    fleet->Records = true;
    for (int i = 0; i < 150; ++i)
    {
        fleet->Inject(0, SealedCall());
        fleet->Run(100ms);
    }
    fleet->Records = false;
    const auto claims = std::count_if(fleet->Recorded.begin(), fleet->Recorded.end(),
                                      [](const Bytes &datagram)
                                      {
                                          Outer outer;
                                          return ReadOuter(datagram, outer) == OuterFault::None &&
                                                 outer.Kind == OuterKind::Claim;
                                      });
    EXPECT_EQ(claims, 15);
    EXPECT_EQ(fleet->OwnBytesOf[1], before.at(1));
    EXPECT_TRUE(fleet->Nodes[0]->Keys->Problems().empty());
}

TEST(SealedBulletins, ThatTheAuthorityDidNotSignAreARowAndNoLines)
{
    const auto fleet = FleetOf(2);
    Bytes bulletin = fleet->BulletinOf(2, {1, 2});
    for (int i = 0; i < 15; ++i)
    {
        ++bulletin.back();
        EXPECT_EQ(fleet->Nodes[0]->Keys->Learn(bulletin), "");
        fleet->Run(1s);
    }
    EXPECT_TRUE(HasRow(*fleet, 0, "uav1", "did not sign"));
}

// Datagrams to an address and port of one session alone are sealed for that session.
class SealedPlaces : public testing::Test
{
protected:
    SealedPlaces() : Fleet(FleetOf(3))
    {
        Fleet->StartAll();
        Fleet->Run(3s);
    }
    void Announce(std::size_t index, std::uint32_t port)
    {
        const auto prefix = Fleet->PrefixOfNode(index);
        Bytes message = RtpsBytes::ParticipantMessage(prefix, port);
        std::copy(Fleet->Nodes[index]->Vendor.begin(), Fleet->Nodes[index]->Vendor.end(), message.begin());
        Bytes sealed;
        ASSERT_TRUE(
            Fleet->Nodes[index]->Core->Seal(message, std::nullopt, OuterClass::Traffic, sealed, Fleet->Now));
        Fleet->Send(index, sealed);
        Fleet->Run(100ms);
    }
    // How many bytes sealing adds to what the first node sends there.
    std::size_t AddedTo(std::uint16_t port)
    {
        const Bytes message = MessageOf(Fleet->Nodes[0]->Vendor);
        const Rabit::Rtps::Place place{.Host = RtpsBytes::SenderHost, .Port = port};
        EXPECT_TRUE(Fleet->Nodes[0]->Core->Seal(message, place, OuterClass::Traffic, Last, Fleet->Now));
        return Last.size() - message.size();
    }

    std::unique_ptr<SealedFleet> Fleet;
    Bytes Last;
};

TEST_F(SealedPlaces, OfOneSessionAreSealedForItAlone)
{
    EXPECT_EQ(AddedTo(7410), 71u);
    Announce(1, 7410);
    EXPECT_EQ(AddedTo(7410), 7u);
    EXPECT_FALSE(Fleet->Inject(1, Last, 0).empty());
    EXPECT_TRUE(Fleet->Inject(2, Last, 0).empty());
    EXPECT_EQ(AddedTo(7411), 71u);
}

TEST_F(SealedPlaces, GetAnnouncementsThatAllCanOpen)
{
    // The third node announces the place of the second one.
    Announce(2, 7410);
    Bytes message = RtpsBytes::ParticipantMessage(Fleet->PrefixOfNode(0), 7414);
    std::copy(Fleet->Nodes[0]->Vendor.begin(), Fleet->Nodes[0]->Vendor.end(), message.begin());
    const Rabit::Rtps::Place place{.Host = RtpsBytes::SenderHost, .Port = 7410};
    ASSERT_TRUE(Fleet->Nodes[0]->Core->Seal(message, place, OuterClass::Traffic, Last, Fleet->Now));
    EXPECT_FALSE(Fleet->Inject(1, Last, 0).empty());
}

TEST_F(SealedPlaces, OfTwoNodesAreSealedForAll)
{
    Announce(1, 7410);
    Announce(2, 7410);
    EXPECT_EQ(AddedTo(7410), 71u);
    Announce(2, 7412);
    EXPECT_EQ(AddedTo(7410), 7u);
    EXPECT_EQ(AddedTo(7412), 7u);
}

TEST_F(SealedPlaces, OfANodeThatStartedAnewAreThoseOfItsNewSession)
{
    Announce(1, 7410);
    Fleet->StartNode(1);
    Fleet->Run(3s);
    Announce(1, 7410);
    EXPECT_EQ(AddedTo(7410), 7u);
    EXPECT_FALSE(Fleet->Inject(1, Last, 0).empty());
}

TEST_F(SealedPlaces, AreKeptInTheNextEpoch)
{
    Announce(1, 7410);
    Fleet->Nodes[0]->Keys->Learn(Fleet->BulletinOf(2, {1, 2, 3}));
    Fleet->Run(5s);
    EXPECT_EQ(AddedTo(7410), 7u);
    EXPECT_FALSE(Fleet->Inject(1, Last, 0).empty());
}

TEST_F(SealedPlaces, AreThoseOfTheOwnParticipantAlone)
{
    Announce(1, 7410);
    // The third node announces the participant of the second one.
    Bytes message = RtpsBytes::ParticipantMessage(Fleet->PrefixOfNode(1), 7499);
    std::copy(Fleet->Nodes[2]->Vendor.begin(), Fleet->Nodes[2]->Vendor.end(), message.begin());
    Bytes sealed;
    ASSERT_TRUE(Fleet->Nodes[2]->Core->Seal(message, std::nullopt, OuterClass::Traffic, sealed, Fleet->Now));
    Fleet->Send(2, sealed);
    Fleet->Run(100ms);
    EXPECT_EQ(AddedTo(7410), 7u);
    EXPECT_EQ(AddedTo(7499), 71u);
}

// Elsewhere its datagrams may be repeated by anybody.
TEST_F(SealedPlaces, AreWhereANodeIsAnsweredThatSendsFromThere)
{
    using Rabit::Rtps::Place;
    Announce(1, 7410);
    Fleet->Hears = [](std::size_t, std::size_t) { return false; };
    Fleet->Run(15s);
    const auto strangersAfterADatagramFrom = [&](const Rabit::Rtps::HostAddress &host)
    {
        Bytes sealed;
        EXPECT_TRUE(Fleet->Nodes[1]->Core->Seal(MessageOf(Fleet->Nodes[1]->Vendor), std::nullopt,
                                                OuterClass::Traffic, sealed, Fleet->Now));
        EXPECT_TRUE(Fleet->Nodes[0]->Core->Open(sealed, {.Host = host, .Port = 40'000}, Fleet->Now).empty());
        return Fleet->Nodes[0]->Core->Strangers(Fleet->Now);
    };
    const Place known{.Host = RtpsBytes::SenderHost, .Port = 7410};
    const Place elsewhere{.Host = {10, 9, 9, 9}, .Port = 0};
    EXPECT_EQ(strangersAfterADatagramFrom(known.Host), std::vector<Place>{known});
    EXPECT_EQ(strangersAfterADatagramFrom(elsewhere.Host), (std::vector<Place>{known, elsewhere}));
}

TEST_F(SealedPlaces, OfARevokedNodeAreNotSealedForIt)
{
    Announce(1, 7410);
    Fleet->Nodes[0]->Keys->Learn(Fleet->BulletinOf(2, {1, 3}, {2}));
    EXPECT_EQ(AddedTo(7410), 71u);
}

}  // namespace
