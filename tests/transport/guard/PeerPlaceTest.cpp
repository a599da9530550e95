// Who may speak in a participant's name, by the address.
#include "guard/PeerPlace.h"

#include <gtest/gtest.h>

namespace
{

using Rabit::Rtps::HostAddress;
using Rabit::Rtps::PeerPlace;
using Rabit::Rtps::UnknownHost;

constexpr HostAddress Home = {10, 0, 0, 1};
constexpr HostAddress SecondHome = {10, 0, 1, 1};
constexpr HostAddress Elsewhere = {10, 0, 0, 66};

class PeerPlaceTest : public testing::Test
{
protected:
    PeerPlaceTest() { Place.Announced(std::vector{Home, SecondHome}, Home, true); }

    bool Believes(const HostAddress &from, std::uint64_t about = 1, std::uint64_t content = 1)
    {
        return Place.Believes(from, {about, content});
    }

    PeerPlace Place;
};

TEST_F(PeerPlaceTest, AllAddressesThatWereAnnouncedAreBelieved)
{
    EXPECT_TRUE(Believes(Home));
    EXPECT_TRUE(Believes(SecondHome));
}

TEST_F(PeerPlaceTest, WhatComesFromElsewhereIsBelievedWhenItIsSaidForTheThirdTime)
{
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
}

TEST_F(PeerPlaceTest, WhatIsSaidOtherwiseBetweenBeginsAnew)
{
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere, 1, 2));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Elsewhere));
}

TEST_F(PeerPlaceTest, EachMatterIsCountedByItself)
{
    for (int time = 0; time < 3; ++time)
    {
        for (std::uint64_t about = 0; about < 40; ++about)
        {
            EXPECT_EQ(Believes(Elsewhere, about), time == 2);
        }
    }
}

TEST_F(PeerPlaceTest, AnAddressThatIsNotKnownIsAsGoodAsAny)
{
    EXPECT_TRUE(Believes(UnknownHost));
}

// As behind an address translation, or on the far network of a host with several.
TEST_F(PeerPlaceTest, WhoIsOnlyHeardFromAnAddressThatItDoesNotNameSpeaksFromThere)
{
    Place.Announced(std::vector{Home}, Elsewhere, true);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Home));
}

TEST_F(PeerPlaceTest, WhoIsOnlyHeardFromSeveralOthersSpeaksFromAll)
{
    Place.Announced(std::vector{Home}, Elsewhere, true);
    Place.Announced(std::vector{Home}, SecondHome, false);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(SecondHome));
}

TEST_F(PeerPlaceTest, RepeatingAnAnnouncementFromEverywhereGivesFewAVoice)
{
    Place.Announced(std::vector{Home}, Elsewhere, true);
    for (std::uint8_t host = 100; host < 200; ++host)
    {
        Place.Announced(std::vector{Home}, {10, 0, 0, host}, false);
    }
    EXPECT_FALSE(Believes({10, 0, 0, 199}));
}

TEST_F(PeerPlaceTest, RepeatingAnAnnouncementGivesNobodyAVoice)
{
    Place.Announced(std::vector{Home, SecondHome}, Elsewhere, false);
    EXPECT_FALSE(Believes(Elsewhere));
    EXPECT_TRUE(Believes(Home));
}

TEST_F(PeerPlaceTest, WhoRepeatedAnAnnouncementFirstLosesItsVoiceWhenTheOwnerIsHeard)
{
    Place.Announced(std::vector{Home}, Elsewhere, true);
    Place.Announced(std::vector{Home}, Home, false);
    EXPECT_FALSE(Believes(Elsewhere));
}

// Multicast on one machine comes from there, and the rest from what was announced.
TEST_F(PeerPlaceTest, TheOwnHostIsBelievedWhateverWasAnnounced)
{
    EXPECT_TRUE(Believes({127, 0, 0, 1}));
    EXPECT_TRUE(Believes({127, 1, 2, 3}));
}

TEST_F(PeerPlaceTest, WhoMovesSpeaksFromItsNewPlaceAlone)
{
    Place.Announced(std::vector{Elsewhere}, Elsewhere, true);
    EXPECT_TRUE(Believes(Elsewhere));
    EXPECT_FALSE(Believes(Home));
}

TEST_F(PeerPlaceTest, AFloodFromElsewhereIsForgottenAndNotBelieved)
{
    for (std::uint64_t about = 0; about < 100'000; ++about)
    {
        EXPECT_FALSE(Believes(Elsewhere, about));
    }
    EXPECT_TRUE(Believes(Home));
}

}  // namespace
