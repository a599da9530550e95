#include "common/HardwareAddresses.h"

#include <gtest/gtest.h>

namespace
{

using namespace std::chrono_literals;
using Rabit::HardwareAddresses;
using Host = HardwareAddresses::Host;

const std::string Head = "IP address       HW type     Flags       HW address            Mask     Device\n";
const std::string Known = "10.0.0.2         0x1         0x2         02:fc:00:00:00:05     *        eth0\n";
const std::string Permanent =
    "10.0.0.3         0x1         0x6         02:fc:00:00:00:06     *        eth0\n";
const std::string Awaited = "10.0.0.2         0x1         0x0         00:00:00:00:00:00     *        eth0\n";
const std::string KnownElsewhere =
    "10.0.0.2         0x1         0x2         02:fc:00:00:00:05     *        wlan0\n";

class HardwareAddressesTest : public testing::Test
{
protected:
    bool IsAwaited(const Host &host = {10, 0, 0, 2}) { return Addresses.IsAwaited(host, Now); }

    std::string Table = Head;
    int Reads = 0;
    HardwareAddresses::TimePoint Now{1h};
    HardwareAddresses Addresses{[this]
                                {
                                    ++Reads;
                                    return Table;
                                }};
};

TEST_F(HardwareAddressesTest, AHostThatTheKernelHasAskedForInVainIsAwaited)
{
    Table = Head + Awaited;
    EXPECT_TRUE(IsAwaited());
}

TEST_F(HardwareAddressesTest, AHostWithAnAddressIsNotAwaited)
{
    Table = Head + Known + Permanent;
    EXPECT_FALSE(IsAwaited());
    EXPECT_FALSE(IsAwaited({10, 0, 0, 3}));
}

TEST_F(HardwareAddressesTest, AHostThatTheKernelHasNotAskedForIsNotAwaited)
{
    Table = Head + Awaited;
    EXPECT_FALSE(IsAwaited({10, 0, 0, 20}));
    EXPECT_FALSE(IsAwaited({192, 168, 1, 1}));
}

TEST_F(HardwareAddressesTest, AnAddressOnOneOfSeveralInterfacesIsEnough)
{
    Table = Head + Awaited + KnownElsewhere;
    EXPECT_FALSE(IsAwaited());
    Table = Head + KnownElsewhere + Awaited;
    Now += HardwareAddresses::Known;
    EXPECT_FALSE(IsAwaited());
}

TEST_F(HardwareAddressesTest, ThisComputerAndGroupsNeedNoTable)
{
    EXPECT_FALSE(IsAwaited({127, 0, 0, 1}));
    EXPECT_FALSE(IsAwaited({239, 255, 0, 1}));
    EXPECT_EQ(Reads, 0);
}

TEST_F(HardwareAddressesTest, AnAddressThatComesIsSeenSoon)
{
    Table = Head + Awaited;
    ASSERT_TRUE(IsAwaited());
    Table = Head + Known;
    Now += HardwareAddresses::Unknown;
    EXPECT_FALSE(IsAwaited());
}

TEST_F(HardwareAddressesTest, AnAddressThatGoesIsSeenWithinASecond)
{
    Table = Head + Known;
    ASSERT_FALSE(IsAwaited());
    Table = Head + Awaited;
    Now += HardwareAddresses::Known;
    EXPECT_TRUE(IsAwaited());
}

TEST_F(HardwareAddressesTest, TheTableIsReadSeldomWhileAllIsKnown)
{
    Table = Head + Known;
    for (int i = 0; i < 1000; ++i, Now += 10ms)
    {
        IsAwaited();
    }
    EXPECT_LE(Reads, 11);
}

TEST_F(HardwareAddressesTest, OneDatagramASecondGoesToAHostThatIsAwaited)
{
    Table = Head + Awaited;
    int asked = 0;
    for (int i = 0; i < 100; ++i, Now += 30ms)
    {
        ASSERT_TRUE(IsAwaited());
        asked += Addresses.HasToAsk({10, 0, 0, 2}, Now) ? 1 : 0;
    }
    EXPECT_EQ(asked, 3);
}

TEST_F(HardwareAddressesTest, AHostWhoseAddressGoesAgainIsAskedForAtOnce)
{
    Table = Head + Awaited;
    ASSERT_TRUE(IsAwaited() && Addresses.HasToAsk({10, 0, 0, 2}, Now));
    Table = Head + Known;
    Now += HardwareAddresses::Unknown;
    ASSERT_FALSE(IsAwaited());
    Table = Head + Awaited;
    Now += HardwareAddresses::Known;
    ASSERT_TRUE(IsAwaited());
    EXPECT_TRUE(Addresses.HasToAsk({10, 0, 0, 2}, Now));
}

TEST_F(HardwareAddressesTest, TheTableIsReadSeldomForAHostBehindARouter)
{
    for (int i = 0; i < 1000; ++i, Now += 10ms)
    {
        EXPECT_FALSE(IsAwaited());
    }
    EXPECT_LE(Reads, 100 + 9);  // every 20 ms for 2 s, then once a second
}

TEST_F(HardwareAddressesTest, AHostInWhosePlaceThisComputerAnswersIsNotAwaited)
{
    Table = Head + "10.0.0.2         0x1         0xc         00:00:00:00:00:00     *        eth0\n";
    EXPECT_FALSE(IsAwaited());
}

TEST_F(HardwareAddressesTest, ATableThatMakesNoSenseHasNoHosts)
{
    Table = "";
    EXPECT_FALSE(IsAwaited());
    Table = Head + "fe80::1 0x1\n10.0.0.2 0x1 none\n10.0.0.2\n\n";
    Now += HardwareAddresses::Known;
    EXPECT_FALSE(IsAwaited());
}

}  // namespace
