// Sessions with threads and the clock of the machine.
#include "envelope/SealedSession.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "../../Eventually.h"
#include "envelope/SealedFleet.h"

namespace
{

using namespace SealedFleets;

constexpr Rabit::Rtps::Place Anywhere{.Host = {127, 0, 0, 1}, .Port = 7410};

std::shared_ptr<Rabit::FleetMember> MemberWithAClock(std::uint8_t number)
{
    SealedFleet fleet;
    const Bytes list = SealedFleet::ListOf(number);
    auto made = Rabit::MakeFleetMember(
        {.SigningKey = SeedOf(3, number).Bytes(),
         .AgreementKey = SeedOf(4, number).Bytes(),
         .Certificate = WriteCertificate({.Name = "uav" + std::to_string(number),
                                          .Number = number,
                                          .Begins = 1'700'000'000,
                                          .Ends = 2'000'000'000,
                                          .Signing = SigningKey::Of(SeedOf(3, number))->Public(),
                                          .Agreement = AgreementKey::Of(SeedOf(4, number))->Public(),
                                          .Permissions = Permissions::HashOf(list)},
                                         fleet.Signs.Signing),
         .Permissions = list,
         .Authority = fleet.Signs.Signing.Public(),
         .Bulletins = {fleet.BulletinOf(1, {1, 2})}});
    EXPECT_EQ(made.Error, "");
    return made.Member;
}

// Two sessions, which hear each other at once.
class SealedSessions : public testing::Test
{
protected:
    ~SealedSessions() override
    {
        A.Stop();
        B.Stop();
    }
    void Start(SealedSession &session, SealedSession &other, std::uint8_t number, std::atomic<int> &sent)
    {
        session.Start(HeaderOf(number), HeaderOf(number, 0x62),
                      {.Send =
                           [&other, &sent](const std::optional<Rabit::Rtps::Place> &to,
                                           std::span<const std::uint8_t> sealed)
                       {
                           EXPECT_FALSE(to.has_value());
                           ++sent;
                           Bytes copy = BytesOf(sealed);
                           other.Open(copy, Anywhere, TimePoint::clock::now());
                       },
                       .Log = {}});
    }
    static bool IsHeard(SealedSession &from, SealedSession &to, std::uint8_t number)
    {
        const Bytes message = MessageOf(HeaderOf(number));
        Bytes sealed;
        return from.Seal(message, std::nullopt, OuterClass::Traffic, sealed) &&
               BytesOf(to.Open(sealed, Anywhere, TimePoint::clock::now())) == message;
    }
    static Rabit::Rtps::GuidPrefix PrefixOfNumber(std::uint8_t number)
    {
        const RtpsHeader header = HeaderOf(number);
        return Rabit::Rtps::PrefixOf(std::span(header).subspan(Prefix));
    }

    const std::shared_ptr<Rabit::DiscoveryTurns> TurnsOfA = std::make_shared<Rabit::DiscoveryTurns>();
    SealedSession A{MemberWithAClock(1), TurnsOfA};
    SealedSession B{MemberWithAClock(2)};
    std::atomic<int> SentByA = 0;
    std::atomic<int> SentByB = 0;
};

TEST_F(SealedSessions, MeetAndOpenEachOthersDatagrams)
{
    Start(A, B, 1, SentByA);
    Start(B, A, 2, SentByB);
    EXPECT_TRUE(RabitTest::Eventually([&] { return IsHeard(A, B, 1) && IsHeard(B, A, 2); }));
    EXPECT_EQ(B.NameOf(PrefixOfNumber(1)), "uav1");
    EXPECT_TRUE(B.MayWrite(PrefixOfNumber(1), "fleet/node1/topic1"));
    EXPECT_FALSE(B.MayWrite(PrefixOfNumber(1), "fleet/node2/topic1"));
    EXPECT_TRUE(B.MayRead(PrefixOfNumber(1), "fleet/node1/topic1"));
    EXPECT_FALSE(B.NameOf(PrefixOfNumber(3)).has_value());
    EXPECT_FALSE(B.MayWrite(PrefixOfNumber(3), "fleet/node1/topic1"));
}

TEST_F(SealedSessions, AreIntroducedInTurnsAloneWhereTheHolderGivesThem)
{
    std::atomic<int> due = 0;
    TurnsOfA->Schedule([&due] { ++due; });
    Start(A, B, 1, SentByA);
    Start(B, A, 2, SentByB);
    EXPECT_TRUE(RabitTest::Eventually([&] { return SentByB > 1 && TurnsOfA->IsDue(); }));
    EXPECT_GE(due.load(), 1);
    EXPECT_EQ(SentByA.load(), 0);
    EXPECT_TRUE(RabitTest::Eventually(
        [&]
        {
            if (TurnsOfA->IsDue() && TurnsOfA->NextBytes() > 0)
            {
                TurnsOfA->SendNext();
            }
            return IsHeard(A, B, 1) && IsHeard(B, A, 2);
        }));
    EXPECT_GE(SentByA.load(), 2);
    A.Stop();
    EXPECT_EQ(TurnsOfA->NextBytes(), 0u);
}

TEST_F(SealedSessions, SealAndOpenNothingBeforeTheStart)
{
    Bytes sealed;
    EXPECT_FALSE(A.IsStarted());
    EXPECT_FALSE(A.Seal(MessageOf(HeaderOf(1)), std::nullopt, OuterClass::Traffic, sealed));
    EXPECT_FALSE(IsHeard(A, B, 1));
    EXPECT_FALSE(A.NameOf(PrefixOfNumber(2)).has_value());
}

TEST_F(SealedSessions, DoNotStartOnceStopped)
{
    A.Stop();
    Start(A, B, 1, SentByA);
    EXPECT_FALSE(A.IsStarted());
}

TEST_F(SealedSessions, SendNothingOnceStopped)
{
    Start(A, B, 1, SentByA);
    EXPECT_TRUE(RabitTest::Eventually([&] { return SentByA > 0; }));
    A.Stop();
    const int before = SentByA;
    // The claims of B ask A, which opens them all the same.
    Start(B, A, 2, SentByB);
    EXPECT_TRUE(RabitTest::Eventually([&] { return SentByB > 3; }));
    EXPECT_EQ(SentByA.load(), before);
}

// ThreadSanitizer sees what both would change.
TEST_F(SealedSessions, MayStartOnOneThreadWhileAnotherStopsThem)
{
    std::thread vendor([this] { Start(A, B, 1, SentByA); });
    A.Stop();
    vendor.join();
    Bytes sealed;
    EXPECT_EQ(A.Seal(MessageOf(HeaderOf(1)), std::nullopt, OuterClass::Traffic, sealed), A.IsStarted());
}

TEST_F(SealedSessions, SealAtMostTheBytesThatTheySay)
{
    Start(A, B, 1, SentByA);
    const Bytes message = MessageOf(HeaderOf(1), 1000);
    Bytes sealed;
    ASSERT_TRUE(A.Seal(message, std::nullopt, OuterClass::Traffic, sealed));
    EXPECT_LE(sealed.size(), message.size() + A.MostAdded());
    EXPECT_FALSE(A.Seal(MessageOf(HeaderOf(5)), std::nullopt, OuterClass::Traffic, sealed));
    EXPECT_TRUE(sealed.empty());
}

}  // namespace
