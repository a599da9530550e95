#include "common/Ledger.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Rtps;

constexpr std::size_t Size = 100;
constexpr std::int64_t OnAir = 128;  // with the headers of IP and UDP

GuidPrefix NameOf(std::size_t number)
{
    return {1, 15, static_cast<std::uint8_t>(number >> 16), static_cast<std::uint8_t>(number >> 8),
            static_cast<std::uint8_t>(number)};
}
HostAddress HostOf(std::size_t number)
{
    return {10, 0, static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number)};
}
Place PlaceOf(std::size_t number)
{
    return {.Host = HostOf(number), .Port = 7411};
}
EntityId EndpointOf(std::size_t number)
{
    return static_cast<EntityId>(number << 8 | 4);
}

class LedgerTest : public testing::Test
{
protected:
    // A participant at a host and a place of its own.
    bool Comes(std::size_t number) { return ComesFrom(number, number); }
    bool ComesFrom(std::size_t number, std::size_t host)
    {
        const auto coming = Accounts.Comes(NameOf(number), HostOf(host), 0, Now);
        const std::vector places{PlaceOf(number)};
        Accounts.SetPlaces(NameOf(number), places);
        return coming != Ledger::Coming::Refused;
    }
    bool HasEndpoint(std::size_t number, std::size_t endpoint)
    {
        return Accounts.HasEndpoint(NameOf(number), EndpointOf(endpoint), {}, Now);
    }
    // How many datagrams go to the place of a participant, of so many.
    std::size_t Go(std::size_t number, std::size_t tried, Ledger::Cargo cargo = Ledger::Cargo::Discovery)
    {
        std::size_t gone = 0;
        for (std::size_t i = 0; i < tried; ++i)
        {
            gone += Accounts.MayGo(PlaceOf(number), Size, cargo, Now) != Ledger::Going::Refused ? 1 : 0;
        }
        return gone;
    }

    Ledger Accounts;
    Ledger::TimePoint Now{1h};
};

TEST_F(LedgerTest, OfOneHostAFewStrangersComeAndAnotherHostIsNotConcerned)
{
    for (std::size_t number = 0; number < 1000; ++number)
    {
        EXPECT_EQ(ComesFrom(number, 7), number < Ledger::MostStrangersOfHost) << number;
    }
    EXPECT_TRUE(ComesFrom(2000, 8));
}

TEST_F(LedgerTest, AParticipantIsNewUntilItsAccountIsOpen)
{
    const auto comes = [&] { return Accounts.Comes(NameOf(1), HostOf(1), 0, Now); };
    EXPECT_EQ(comes(), Ledger::Coming::New);
    EXPECT_EQ(comes(), Ledger::Coming::Known);
    Accounts.Left(NameOf(1));
    EXPECT_EQ(comes(), Ledger::Coming::New);
}

TEST_F(LedgerTest, OfAllHostsTogetherSomeStrangersCome)
{
    for (std::size_t number = 0; number < 1000; ++number)
    {
        EXPECT_EQ(Comes(number), number < Ledger::MostStrangers) << number;
    }
}

TEST_F(LedgerTest, AFleetOfAHundredIsFarFromAllLimits)
{
    for (std::size_t number = 0; number < 100; ++number)
    {
        ASSERT_TRUE(Comes(number));
        for (std::size_t endpoint = 0; endpoint < 20; ++endpoint)
        {
            ASSERT_TRUE(HasEndpoint(number, endpoint));
        }
    }
    for (std::size_t number = 0; number < 100; ++number)
    {
        EXPECT_TRUE(Accounts.Spoke(NameOf(number)));
        for (std::size_t endpoint = 0; endpoint < 100; ++endpoint)
        {
            ASSERT_TRUE(HasEndpoint(number, endpoint));
        }
        EXPECT_EQ(Go(number, 1000), 1000u);
    }
    EXPECT_EQ(Accounts.Refusals(), 0u);
}

TEST_F(LedgerTest, StrangersHaveFewEndpointsAndThoseThatAreGoneDoNotCount)
{
    ASSERT_TRUE(ComesFrom(1, 7));
    ASSERT_TRUE(ComesFrom(2, 7));
    for (std::size_t endpoint = 0; endpoint < 1000; ++endpoint)
    {
        EXPECT_EQ(HasEndpoint(1, endpoint), endpoint < Ledger::MostEndpointsOfHost) << endpoint;
    }
    EXPECT_FALSE(HasEndpoint(2, 1));
    Accounts.EndpointGone(NameOf(1), EndpointOf(5));
    EXPECT_TRUE(HasEndpoint(2, 1));
    EXPECT_FALSE(HasEndpoint(2, 2));
    Accounts.Left(NameOf(1));
    EXPECT_TRUE(HasEndpoint(2, 2));
}

TEST_F(LedgerTest, EachParticipantAndAllOfThemHaveALimitOfEndpoints)
{
    std::size_t all = 0;
    for (std::size_t number = 0; number < 50; ++number)
    {
        ASSERT_TRUE(Comes(number));
        ASSERT_TRUE(Accounts.Spoke(NameOf(number)));
        for (std::size_t endpoint = 0; endpoint < 2000; ++endpoint)
        {
            const bool fits = endpoint < Ledger::MostEndpointsOfOne && all < Ledger::MostEndpoints;
            ASSERT_EQ(HasEndpoint(number, endpoint), fits);
            all += fits ? 1 : 0;
        }
    }
    EXPECT_EQ(all, Ledger::MostEndpoints);
}

TEST_F(LedgerTest, StrangersGetAsMuchAsCameFromThemAndAShareOfTheAllowance)
{
    ASSERT_TRUE(Comes(1));
    const std::size_t free = static_cast<std::size_t>(Ledger::Allowance / OnAir);
    EXPECT_EQ(Go(1, 1000), free);
    for (int i = 0; i < 5; ++i)
    {
        Accounts.Came(NameOf(1), Size);
    }
    EXPECT_EQ(Go(1, 1000), 5u);
    Now += 10s;
    EXPECT_EQ(Go(1, 1000), static_cast<std::size_t>(10 * Ledger::AllowanceRate / OnAir));
}

TEST_F(LedgerTest, StrangersOfAListedHostGetAllAndAreFew)
{
    Ledger accounts({HostOf(7)});
    std::size_t come = 0;
    for (std::size_t number = 0; number < 1000; ++number)
    {
        const auto coming = accounts.Comes(NameOf(number), HostOf(7), 0, Now);
        come += coming != Ledger::Coming::Refused ? 1 : 0;
        const std::vector places{PlaceOf(number)};
        accounts.SetPlaces(NameOf(number), places);
    }
    EXPECT_EQ(come, Ledger::MostStrangersOfHost);
    for (int i = 0; i < 10'000; ++i)
    {
        ASSERT_EQ(accounts.MayGo(PlaceOf(1), Size, Ledger::Cargo::Discovery, Now), Ledger::Going::Freely);
    }
}

TEST_F(LedgerTest, AHostFullOfStrangersCostsNoMoreThanOne)
{
    for (std::size_t number = 0; number < Ledger::MostStrangers; ++number)
    {
        ASSERT_TRUE(Comes(number));
    }
    std::size_t gone = 0;
    for (int second = 0; second < 60; ++second)
    {
        Now += 1s;
        for (std::size_t number = 0; number < Ledger::MostStrangers; ++number)
        {
            gone += Go(number, 20);
        }
    }
    EXPECT_LE(static_cast<std::int64_t>(gone) * OnAir, Ledger::Allowance + 60 * Ledger::AllowanceRate);
}

TEST_F(LedgerTest, AParticipantThatHasSpokenGetsAll)
{
    ASSERT_TRUE(Comes(1));
    EXPECT_TRUE(Accounts.IsStranger(NameOf(1)));
    EXPECT_TRUE(Accounts.Spoke(NameOf(1)));
    EXPECT_FALSE(Accounts.Spoke(NameOf(1)));
    EXPECT_FALSE(Accounts.IsStranger(NameOf(1)));
    EXPECT_EQ(Go(1, 10'000), 10'000u);
}

TEST_F(LedgerTest, TheFirstProgramsThatOnlyListenGetAll)
{
    for (std::size_t number = 0; number < 20; ++number)
    {
        ASSERT_TRUE(Comes(number));
        Accounts.Listens(NameOf(number));
        EXPECT_EQ(Accounts.IsStranger(NameOf(number)), number >= Ledger::MostListeners) << number;
    }
    Accounts.Left(NameOf(0));
    Accounts.Listens(NameOf(15));
    EXPECT_FALSE(Accounts.IsStranger(NameOf(15)));
}

TEST_F(LedgerTest, AStrangerThatNamesAnotherOnesPlaceChangesNothingThere)
{
    ASSERT_TRUE(Comes(1));
    Accounts.Spoke(NameOf(1));
    ASSERT_TRUE(ComesFrom(2, 9));
    const std::vector places{PlaceOf(1)};
    Accounts.SetPlaces(NameOf(2), places);
    EXPECT_EQ(Go(1, 10'000), 10'000u);
    Accounts.Left(NameOf(2));
    EXPECT_EQ(Go(1, 10'000), 10'000u);
}

TEST_F(LedgerTest, APlaceThatNobodyHasAnnouncedIsAStrangersUnlessItsHostIsListed)
{
    Ledger accounts({HostOf(7)});
    std::size_t gone = 0;
    for (int i = 0; i < 10'000; ++i)
    {
        ASSERT_EQ(accounts.MayGo(PlaceOf(7), Size, Ledger::Cargo::Discovery, Now), Ledger::Going::Freely);
        gone +=
            accounts.MayGo(PlaceOf(5), Size, Ledger::Cargo::Discovery, Now) != Ledger::Going::Refused ? 1 : 0;
    }
    EXPECT_EQ(static_cast<std::int64_t>(gone), Ledger::Allowance / OnAir);
}

// A program that only writes cannot speak before it knows us, for which it needs our discovery.
TEST_F(LedgerTest, SamplesLeaveAStrangerHalfOfAllForDiscovery)
{
    ASSERT_TRUE(Comes(1));
    Accounts.Came(NameOf(1), 20 * Size);
    const std::size_t ofAllowance = static_cast<std::size_t>(Ledger::Allowance / 2 / OnAir);
    const std::size_t ofCredit = 20 * Size / 2 / static_cast<std::size_t>(OnAir);
    EXPECT_EQ(Go(1, 10'000, Ledger::Cargo::Samples), ofCredit + ofAllowance);
    EXPECT_GE(Go(1, 10'000), ofCredit + ofAllowance);
    for (int second = 0; second < 60; ++second)
    {
        Now += 1s;
        Accounts.Came(NameOf(1), Size);
        EXPECT_EQ(Go(1, 100, Ledger::Cargo::Samples), second % 2 == 0 ? 1u : 0u) << second;
        EXPECT_GE(Go(1, 100), static_cast<std::size_t>(Ledger::AllowanceRate / OnAir));
    }
}

TEST_F(LedgerTest, AHostThatIsRefusedSomethingInManySecondsIsNamed)
{
    for (std::size_t number = 0; number <= Ledger::MostStrangersOfHost; ++number)
    {
        ComesFrom(number, 7);
    }
    EXPECT_EQ(Accounts.Refusals(), 1u);
    EXPECT_TRUE(Accounts.LastingRefusals(Now).empty());
    for (int second = 1; second < Ledger::LastingSeconds; ++second)
    {
        Now += 1s;
        ComesFrom(1000, 7);
    }
    ASSERT_EQ(Accounts.LastingRefusals(Now).size(), 1u);
    EXPECT_EQ(Accounts.LastingRefusals(Now)[0].Address(), "10.0.0.7");
    EXPECT_EQ(Accounts.LastingRefusals(Now)[0].Times, 10u);
    EXPECT_TRUE(Accounts.LastingRefusals(Now + Ledger::Pause).empty());
}

}  // namespace
