// The guard stops or blanks datagrams of published faults of the vendors (README.md).
#include <gtest/gtest.h>

#include <algorithm>

#include "common/RtpsReader.h"
#include "faults/Datagrams.h"
#include "guard/DeliveryCheck.h"
#include "guard/Gate.h"

namespace
{

using namespace Faults;
using Rabit::Rtps::RtpsGuard;
using RtpsBytes::Gate;

// True if something got through that has the bytes.
bool Delivers(const Gate &guard, const Bytes &bytes)
{
    return std::any_of(
        guard.Handed.begin(), guard.Handed.end(),
        [&](const Bytes &message)
        { return std::search(message.begin(), message.end(), bytes.begin(), bytes.end()) != message.end(); });
}

// The sender has announced itself.
class FastDdsFaults : public testing::Test
{
protected:
    FastDdsFaults() { EXPECT_TRUE(Guard.Admit(Announcement())); }

    bool Delivers(const Bytes &bytes) const { return ::Delivers(Guard, bytes); }

    Gate Guard;
};

class CycloneDdsFaults : public FastDdsFaults
{
};

constexpr std::uint16_t PropertyList = 0x0059;
constexpr std::uint16_t TypeInformation = 0x0075;

// The first number behind a gap that is the only submessage of a message.
std::int64_t BaseOfGap(const Bytes &message)
{
    constexpr std::size_t BaseAt = 20 + 4 + 16;
    return Rabit::Rtps::RtpsReader(std::span(message).subspan(BaseAt), true).Sequence();
}

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
TEST(FastDdsFaultsWithSharedMemory, Cve2025_64438_AGapOfBillionsIsNarrowed)
{
    constexpr std::size_t BaseAt = 20 + 4 + 16;
    Gate guard(RtpsGuard::Mode::StructureOnly);
    ASSERT_TRUE(guard.Admit(GapOfBillions()));
    ASSERT_EQ(guard.Handed.size(), 1u);
    const Bytes &gap = guard.Handed.front();
    EXPECT_EQ(Bytes(gap.begin() + BaseAt, gap.begin() + BaseAt + 8),
              RtpsBytes::Sequence(2 + Rabit::Rtps::WalkBudget::Burst + Rabit::Rtps::WalkBudget::Free));
}

TEST_F(FastDdsFaults, Cve2023_50257_AGoodbyeFromAnotherAddressIsStopped)
{
    Guard.From = {10, 0, 0, 66};
    EXPECT_TRUE(Guard.Stops(Goodbye()));
}

TEST_F(FastDdsFaults, Issue6437_Cve2026_55063_APartitionWithoutAnEndIsStopped)
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

TEST_F(FastDdsFaults, GhsaF4hw_AGapFromTheAwaitedNumberIsStopped)
{
    EXPECT_TRUE(Guard.Stops(GapFromTheAwaitedNumber()));
    EXPECT_TRUE(Guard.Stops(GapToTheHighestNumbers()));
}

TEST(FastDdsFaultsWithSharedMemory, GhsaF4hw_AGapFromTheAwaitedNumberIsNarrowedOrStopped)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    ASSERT_TRUE(guard.Admit(GapFromTheAwaitedNumber()));
    ASSERT_EQ(guard.Handed.size(), 1u);
    EXPECT_EQ(BaseOfGap(guard.Handed.front()),
              1 + Rabit::Rtps::WalkBudget::Burst + Rabit::Rtps::WalkBudget::Free);
    EXPECT_TRUE(guard.Stops(GapToTheHighestNumbers()));
}

TEST_F(FastDdsFaults, Ghsa57rp_TheHighestNumbersAreStopped)
{
    EXPECT_TRUE(Guard.Stops(SampleOfTheHighestNumbers()));
    EXPECT_TRUE(Guard.Stops(HeartbeatBehindThatSample()));
}

TEST_F(FastDdsFaults, Ghsa6m2p_AHeartbeatOfTheLastNumberIsStopped)
{
    EXPECT_TRUE(Guard.Stops(HeartbeatOfTheLastNumber()));
}

TEST(FastDdsFaultsWithSharedMemory, Ghsa57rp_Ghsa6m2p_TheHighestNumbersAreStopped)
{
    Gate guard(RtpsGuard::Mode::StructureOnly);
    EXPECT_TRUE(guard.Stops(SampleOfTheHighestNumbers()));
    EXPECT_TRUE(guard.Stops(HeartbeatBehindThatSample()));
    EXPECT_TRUE(guard.Stops(HeartbeatOfTheLastNumber()));
}

// Honest samples have any size. The buffers of nodes have room for the mark (PayloadPoolTest).
TEST_F(FastDdsFaults, Cve2025_62799_FragmentsWhoseTailIsShortPass)
{
    EXPECT_TRUE(Guard.Admit(WriterOfFragments()));
    EXPECT_TRUE(Guard.Passes(FragmentsWhoseTailIsShort()));
}

TEST_F(FastDdsFaults, Cve2025_62799_FragmentsShorterThanTheVendorsMarkAreStopped)
{
    EXPECT_TRUE(Guard.Admit(WriterOfFragments()));
    EXPECT_TRUE(Guard.Stops(FragmentsShorterThanTheVendorsMark()));
}

TEST_F(FastDdsFaults, Cve2025_65865_InlineQosBeyondTheEndOfAFragmentIsStopped)
{
    EXPECT_TRUE(Guard.Admit(WriterOfFragments()));
    EXPECT_TRUE(Guard.Stops(FragmentWithInlineQosBeyondItsEnd()));
}

TEST_F(FastDdsFaults, Cve2026_22590_ALastFragmentWithoutItsBytesIsStopped)
{
    EXPECT_TRUE(Guard.Admit(WriterOfFragments()));
    EXPECT_TRUE(Guard.Stops(LastFragmentWithoutItsBytes()));
}

// No datagram tells whose address that is, so the announcement passes.
TEST(FastDdsAnnouncementFaults, Cve2021_38425_AParticipantAtAnothersAddressHasAShortLease)
{
    const auto lease = [](std::uint32_t seconds) {
        return RtpsBytes::Parameter(0x0002, RtpsBytes::Join({RtpsBytes::U32(seconds), RtpsBytes::U32(0)}));
    };
    Gate guard;
    EXPECT_TRUE(guard.Admit(ParticipantAtAnothersAddress()));
    EXPECT_TRUE(Delivers(guard, lease(300)));
    EXPECT_FALSE(Delivers(guard, lease(86'400)));
}

TEST(FastDdsAnnouncementFaults, Cve2021_38425_AnothersAddressIsSentNoMoreThanCameFromItsParticipants)
{
    using Rabit::Rtps::Ledger;
    constexpr std::size_t Size = 100;
    constexpr std::size_t Times = 1000;
    constexpr std::size_t IpAndUdp = 28;
    const Rabit::Rtps::Place victim{.Host = {10, 0, 0, 99}, .Port = 9};
    const Rabit::Rtps::HostAddress forger = {10, 0, 0, 66};
    const RtpsGuard::TimePoint now{std::chrono::hours(1)};
    RtpsGuard guard(RtpsGuard::Mode::Full, std::chrono::seconds(10));
    Bytes datagram = ParticipantAtAnothersAddress();
    ASSERT_TRUE(guard.Admit(datagram, forger, now, [](std::span<std::uint8_t>) {}));
    Rabit::HardwareAddresses addresses([] { return std::string(); });  // the kernel awaits none
    std::size_t sent = 0;
    for (std::size_t i = 0; i < Times; ++i)
    {
        sent += guard.MayGo(victim, Size, Ledger::Cargo::Discovery, addresses, now) ? Size + IpAndUdp : 0;
    }
    EXPECT_LE(sent, datagram.size() + IpAndUdp + std::size_t{Ledger::Allowance});
}

TEST_F(FastDdsFaults, Cve2026_49861_RepresentationsThatAreNotThereAreStopped)
{
    EXPECT_TRUE(Guard.Stops(RepresentationsThatAreNotThere()));
}

// The guard blanks parameters that nodes do not use.
TEST_F(FastDdsFaults, Cve2026_49861_DomainsThatAreNotThereAreBlanked)
{
    constexpr std::uint16_t DataSharing = 0x8006;
    EXPECT_TRUE(Guard.Admit(DomainsThatAreNotThere()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(DataSharing)));
}

TEST_F(FastDdsFaults, Cve2026_53589_AddressesThatAreNotThereAreBlanked)
{
    constexpr std::uint16_t EndpointSettings = 0x8010;
    EXPECT_TRUE(Guard.Admit(AddressesThatAreNotThere()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(EndpointSettings)));
}

TEST_F(FastDdsFaults, Cve2026_53590_PropertiesAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(EmptyPropertiesThatAreNotThere()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(PropertyList)));
}

TEST_F(FastDdsFaults, Cve2026_49863_DescriptionsOfTypesAreBlanked)
{
    EXPECT_TRUE(Guard.Admit(TypesBehindTheirParameter()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(TypeInformation)));
}

TEST_F(FastDdsFaults, Ghsa8g7x_APartitionLongerThanItsListIsStopped)
{
    EXPECT_TRUE(Guard.Stops(PartitionLongerThanItsList()));
}

TEST_F(FastDdsFaults, Cve2026_22591_FiltersAreBlanked)
{
    constexpr std::uint16_t ContentFilter = 0x0035;
    EXPECT_TRUE(Guard.Admit(ReaderWithANestedFilter()));
    EXPECT_EQ(Guard.Handed.size(), 1u);
    EXPECT_FALSE(Delivers(RtpsBytes::U16(ContentFilter)));
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

TEST_F(CycloneDdsFaults, Issue2402_AMessageOfAHeaderAloneIsIgnored)
{
    for (const auto mode : {RtpsGuard::Mode::Full, RtpsGuard::Mode::StructureOnly})
    {
        Gate guard(mode);
        EXPECT_TRUE(guard.Admit(MessageOfAHeaderAlone()));
        EXPECT_TRUE(guard.Handed.empty());
    }
}

TEST_F(CycloneDdsFaults, PullRequest2335_WhatConcernsAnotherParticipantIsStopped)
{
    EXPECT_TRUE(Guard.Stops(WriterOfAnother()));
    EXPECT_TRUE(Guard.Stops(LivelinessOfAnother()));
    EXPECT_TRUE(Guard.Stops(GoodbyeOfAnother()));
}

}  // namespace
