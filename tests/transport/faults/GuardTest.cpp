// The guard stops or blanks datagrams of published faults of the vendors (README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "common/RtpsReader.h"
#include "faults/Datagrams.h"
#include "guard/DeliveryCheck.h"
#include "guard/Gate.h"

namespace
{

using namespace Faults;
using Rabit::Rtps::RtpsGuard;
using RtpsBytes::Gate;

// Modes with DDS Security, of a governance like ours and of any other.
constexpr std::array WithKeys = {RtpsGuard::Mode::Protected, RtpsGuard::Mode::Secured};

// The sender has announced itself.
class FastDdsFaults : public testing::Test
{
protected:
    FastDdsFaults() { EXPECT_TRUE(Guard.Admit(Announcement())); }

    // True if something gets through that has the bytes.
    bool Delivers(const Bytes &bytes) const
    {
        return std::any_of(Guard.Handed.begin(), Guard.Handed.end(),
                           [&](const Bytes &message) {
                               return std::search(message.begin(), message.end(), bytes.begin(),
                                                  bytes.end()) != message.end();
                           });
    }

    Gate Guard;
};

class CycloneDdsFaults : public FastDdsFaults
{
};

constexpr std::uint16_t PropertyList = 0x0059;
constexpr std::uint16_t TypeInformation = 0x0075;

TEST_F(FastDdsFaults, Cve2023_39946_PropertiesAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(PropertyLongerThanItsList()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(PropertyList)));
}

TEST_F(FastDdsFaults, Cve2023_39947_PropertiesAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(PropertiesThatAreNotThere()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(PropertyList)));
}

TEST_F(FastDdsFaults, Cve2023_39945_DescriptionsOfTypesAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(DescriptionOfATypeThatIsNone()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(TypeInformation)));
}

TEST_F(FastDdsFaults, Cve2023_39948_RequestsForTypesAreIgnored)
{
    EXPECT_TRUE(Guard.Admit(RequestForTypesThatIsNone()));
    EXPECT_TRUE(Guard.Handed.empty());
}

TEST_F(FastDdsFaults, Cve2023_39949_NegativeNumbersAreStopped)
{
    EXPECT_TRUE(Guard.Stops(HeartbeatOfNegativeNumbers()));
}

TEST_F(FastDdsFaults, Cve2023_39534_AGapFromNumberZeroIsStopped)
{
    EXPECT_TRUE(Guard.Stops(GapFromNumberZero()));
}

TEST_F(FastDdsFaults, Cve2023_39534_AGapThatEndsBeforeItBeginsIsStopped)
{
    EXPECT_TRUE(Guard.Stops(GapThatEndsBeforeItBegins()));
}

TEST_F(FastDdsFaults, Cve2023_42459_InlineQosOutsideASampleIsStopped)
{
    EXPECT_TRUE(Guard.Stops(SampleWithInlineQosOutside()));
}

TEST_F(FastDdsFaults, Cve2023_50716_InlineQosOutsideAFragmentIsStopped)
{
    EXPECT_TRUE(Guard.Stops(FragmentWithInlineQosOutside()));
}

TEST_F(FastDdsFaults, Cve2024_28231_InlineQosBeyondTheEndOfASampleIsStopped)
{
    EXPECT_TRUE(Guard.Stops(SampleWithInlineQosBeyondItsEnd()));
}

TEST_F(FastDdsFaults, Cve2025_64438_AGapOfBillionsIsStopped)
{
    EXPECT_TRUE(Guard.Stops(GapOfBillions()));
}

TEST_F(FastDdsFaults, Cve2025_65016_RisingHeartbeatsAreCutToTheStepsThatTheirDatagramsPayFor)
{
    using Rabit::Rtps::WalkBudget;
    constexpr std::size_t FirstAt = 20 + 4 + 8;
    const auto heartbeats = Faults::RisingHeartbeats();
    std::int64_t reached = 0;
    for (const Bytes &heartbeat : heartbeats)
    {
        Guard.Admit(heartbeat);
        for (const Bytes &given : Guard.Handed)
        {
            reached = std::max(reached,
                               Rabit::Rtps::RtpsReader(std::span(given).subspan(FirstAt), true).Sequence());
        }
    }
    EXPECT_LE(reached, static_cast<std::int64_t>(heartbeats.size()) * WalkBudget::Free);
}

// The guard cannot know there what the writer has sent. It lets through as many numbers as cost the vendor
// little.
TEST(FastDdsFaultsWithKeys, Cve2025_64438_AGapOfBillionsIsNarrowed)
{
    constexpr std::size_t BaseAt = 20 + 4 + 16;
    Gate guard(RtpsGuard::Mode::Secured);
    ASSERT_TRUE(guard.Admit(GapOfBillions()));
    ASSERT_EQ(guard.Handed.size(), 1u);
    const Bytes &gap = guard.Handed.front();
    EXPECT_EQ(Bytes(gap.begin() + BaseAt, gap.begin() + BaseAt + 8),
              RtpsBytes::Sequence(2 + Rabit::Rtps::WalkBudget::Burst + Rabit::Rtps::WalkBudget::Free));
}

TEST(FastDdsFaultsWithKeys, Cve2025_64438_AGapInPlainIsStoppedWhereAllIsProtected)
{
    Gate guard(RtpsGuard::Mode::Protected);
    EXPECT_TRUE(guard.Stops(GapOfBillions()));
}

TEST_F(FastDdsFaults, Cve2023_50257_AGoodbyeFromAnotherAddressIsStopped)
{
    Guard.From = {10, 0, 0, 66};
    EXPECT_TRUE(Guard.Stops(Goodbye()));
}

// Nothing in it is signed: DDS Security as the vendor has it leaves goodbyes unprotected.
TEST(FastDdsFaultsWithKeys, Cve2023_50257_AGoodbyeFromAnotherAddressIsStoppedHoweverOftenItComes)
{
    for (const auto mode : WithKeys)
    {
        Gate guard(mode);
        ASSERT_TRUE(guard.Admit(Announcement()));
        const auto home = guard.From;
        guard.From = {10, 0, 0, 66};
        for (int i = 0; i < 10; ++i)
        {
            EXPECT_TRUE(guard.Stops(Goodbye()));
            // The sender's own announcement, which anybody can repeat.
            EXPECT_TRUE(guard.Admit(Announcement()));
        }
        guard.From = home;
        EXPECT_TRUE(guard.Admit(Goodbye()));
        EXPECT_EQ(guard.Handed.size(), 1u);
    }
}

TEST_F(FastDdsFaults, Issue6437_APartitionWithoutAnEndIsStopped)
{
    EXPECT_TRUE(Guard.Stops(PartitionWithoutAnEnd()));
}

TEST_F(FastDdsFaults, Issue1337_AnAcknowledgementOfTooManyBitsIsStopped)
{
    EXPECT_TRUE(Guard.Stops(AcknowledgementOfTooManyBits()));
}

TEST_F(FastDdsFaults, Issue3931_AHeartbeatFarAheadIsStopped)
{
    EXPECT_TRUE(Guard.Admit(HonestHeartbeat()));
    EXPECT_TRUE(Guard.Stops(HeartbeatFarAhead()));
}

TEST(FastDdsFaultsWithKeys, Cve2025_62599_CountlessPropertiesAreStopped)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Stops(TokenOfCountlessProperties()));
    }
}

TEST(FastDdsFaultsWithKeys, Cve2025_62600_CountlessBinaryPropertiesAreStopped)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Stops(TokenOfCountlessBinaryProperties()));
    }
}

TEST(FastDdsFaultsWithKeys, Cve2025_62602_AnEndlessValueIsStopped)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Stops(TokenWithAnEndlessValue()));
    }
}

TEST(FastDdsFaultsWithKeys, Cve2025_64098_AValueLongerThanItsTokenIsStopped)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Stops(TokenWithALongValue()));
    }
}

TEST(FastDdsFaultsWithKeys, SoundTokensPass)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Passes(AnnouncementWithTokens()));
    }
}

TEST(FastDdsFaultsWithKeys, Cve2025_62603_CountlessTokensAreStopped)
{
    for (const auto mode : WithKeys)
    {
        EXPECT_TRUE(Gate(mode).Stops(HandshakeOfCountlessTokens()));
    }
}

// Encrypted, by a participant that has keys, it passes: the guard has none.
TEST(FastDdsFaultsWithKeys, Issue6345_KeyMaterialInPlainIsStopped)
{
    EXPECT_TRUE(Gate(RtpsGuard::Mode::Protected).Stops(ShortKeyMaterial()));
}

TEST_F(CycloneDdsFaults, Issue1555_ASampleThatEndsBeforeItsInlineQosIsStopped)
{
    EXPECT_TRUE(Guard.Stops(SampleThatEndsBeforeItsInlineQos()));
}

TEST_F(CycloneDdsFaults, Issue1751_LivelinessAsAParameterListIsStopped)
{
    EXPECT_TRUE(Guard.Stops(LivelinessAsAParameterList()));
}

TEST_F(CycloneDdsFaults, Issue1758_AParticipantWithoutALeaseIsStopped)
{
    EXPECT_TRUE(Guard.Stops(ParticipantWithoutALease()));
}

TEST_F(CycloneDdsFaults, Issue1771_LivelinessOfFourBytesIsStopped)
{
    EXPECT_TRUE(Guard.Stops(LivelinessOfFourBytes()));
}

TEST_F(CycloneDdsFaults, Issue1772_AParticipantAtPortZeroIsStopped)
{
    EXPECT_TRUE(Guard.Stops(ParticipantAtPortZero()));
}

TEST_F(CycloneDdsFaults, Issue1854_AHeartbeatFarAheadIsStopped)
{
    EXPECT_TRUE(Guard.Admit(HonestHeartbeat()));
    EXPECT_TRUE(Guard.Stops(HeartbeatFarAhead()));
}

}  // namespace
