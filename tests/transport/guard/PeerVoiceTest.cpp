// From which addresses data in a participant's name is accepted.
#include "guard/PeerVoice.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace
{

using Rabit::Rtps::HostAddress;
using Rabit::Rtps::PeerVoice;
using Rabit::Rtps::UnknownHost;

constexpr HostAddress Home = {10, 0, 0, 1};
constexpr HostAddress SecondHome = {10, 0, 1, 1};
constexpr HostAddress Elsewhere = {10, 0, 0, 66};

class PeerVoiceTest : public testing::Test
{
protected:
    PeerVoiceTest() { Place.Announced(std::vector{Home, SecondHome}, Home); }

    bool Believes(const HostAddress &from, std::uint64_t about = 1, std::uint64_t content = 1)
    {
        return Place.Believes(from, {about, content});
    }

    PeerVoice Place;
};

TEST_F(PeerVoiceTest, AllAddressesThatWereAnnouncedAreBelieved)
{
    EXPECT_TRUE(Believes(Home));
    EXPECT_TRUE(Believes(SecondHome));
}

TEST_F(PeerVoiceTest, WhatComesFromElsewhereIsBelievedWhenItIsSaidForTheThirdTime)
{
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
}

TEST_F(PeerVoiceTest, WhatIsSaidOtherwiseBetweenBeginsAnew)
{
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere, 1, 2));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
}

TEST_F(PeerVoiceTest, EachMatterIsCountedByItself)
{
    for (int time = 0; time < 3; ++time)
    {
        for (std::uint64_t about = 0; about < 40; ++about)
        {
            EXPECT_EQ(Believes(Elsewhere, about), time == 2);
        }
    }
}

TEST_F(PeerVoiceTest, AnAddressThatIsNotKnownIsAsGoodAsAny)
{
    EXPECT_TRUE(Believes(UnknownHost));
}

// For example behind an address translation, or on the far network of a host with several.
TEST_F(PeerVoiceTest, WhoIsOnlyHeardFromAnAddressThatItDoesNotNameSpeaksFromThere)
{
    Place.Announced(std::vector{Home}, Elsewhere);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Home));
}

TEST_F(PeerVoiceTest, WhoIsOnlyHeardFromSeveralOthersSpeaksFromAll)
{
    Place.Announced(std::vector{Home}, Elsewhere);
    Place.Announced(std::vector{Home}, SecondHome);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(SecondHome));
}

TEST_F(PeerVoiceTest, RepeatingAnAnnouncementFromEverywhereGivesFewAVoice)
{
    Place.Announced(std::vector{Home}, Elsewhere);
    for (std::uint8_t host = 100; host < 200; ++host)
    {
        Place.Announced(std::vector{Home}, {10, 0, 0, host});
    }
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes({10, 0, 0, 195}));
}

TEST_F(PeerVoiceTest, RepeatingAnAnnouncementGivesNobodyAVoice)
{
    Place.Announced(std::vector{Home, SecondHome}, Elsewhere);
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Home));
}

TEST_F(PeerVoiceTest, WhoRepeatedAnAnnouncementFirstLosesItsVoiceWhenTheOwnerIsHeard)
{
    Place.Announced(std::vector{Home}, Elsewhere);
    Place.Announced(std::vector{Home}, Home);
    EXPECT_FALSE(Believes(Elsewhere));
}

// On one machine, multicast comes from loopback and everything else from the announced address.
TEST_F(PeerVoiceTest, TheOwnHostIsBelievedWhateverWasAnnounced)
{
    EXPECT_TRUE(Believes({127, 0, 0, 1}));
    EXPECT_TRUE(Believes({127, 1, 2, 3}));
}

TEST_F(PeerVoiceTest, WhoMovesSpeaksFromItsNewPlaceAlone)
{
    Place.Announced(std::vector{Elsewhere}, Elsewhere);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Home));
}

// A participant with more endpoints than are remembered. It does not repeat an announcement that was
// accepted.
TEST_F(PeerVoiceTest, WhoHasMuchToSayFromElsewhereIsBelievedInTheEnd)
{
    constexpr std::uint64_t Odd = 0x9e3779b97f4a7c15u;  // spreads them, as a digest does
    std::set<std::uint64_t> believed;
    for (int time = 0; time < 20; ++time)
    {
        for (std::uint64_t about = 0; about < 1500; ++about)
        {
            if (believed.count(about) == 0 && Believes(Elsewhere, about * Odd))
            {
                believed.insert(about);
            }
        }
    }
    EXPECT_EQ(believed.size(), 1500u);
}

TEST_F(PeerVoiceTest, WhoAnnouncesItselfFromThisHostGivesNobodyElseAVoice)
{
    Place.Announced(std::vector{Home}, {127, 0, 0, 1});
    Place.Announced(std::vector{Home}, Elsewhere);
    EXPECT_FALSE(Believes(Elsewhere));
}

TEST_F(PeerVoiceTest, AFloodFromElsewhereIsForgottenAndNotBelieved)
{
    for (std::uint64_t about = 0; about < 100'000; ++about)
    {
        EXPECT_FALSE(Believes(Elsewhere, about));
    }
    EXPECT_TRUE(Believes(Home));
}

}  // namespace
