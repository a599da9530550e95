#include "Frame.h"
#include "NodeCounters.h"

#include <gmock/gmock.h>

namespace Rabit::Radio
{
namespace
{

using namespace std::chrono_literals;

// Ethernet and IPv4, with a destination port where the protocol has one.
Frame Ipv4Frame(std::uint8_t protocol, std::uint16_t port, std::uint16_t fragment = 0)
{
    Frame frame(EthernetHeader + 20 + 8 + 10);
    frame[0] = 2;
    frame[12] = 0x08;
    frame[EthernetHeader] = 0x45;
    frame[EthernetHeader + 6] = static_cast<std::uint8_t>(fragment >> 8);
    frame[EthernetHeader + 7] = static_cast<std::uint8_t>(fragment);
    frame[EthernetHeader + 9] = protocol;
    frame[EthernetHeader + 22] = static_cast<std::uint8_t>(port >> 8);
    frame[EthernetHeader + 23] = static_cast<std::uint8_t>(port);
    return frame;
}

TEST(FrameTest, AKindIsNamedByAddressProtocolAndPort)
{
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(17, 7411))), "unicast udp 7411");
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(6, 80))), "unicast tcp 80");
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(2, 9))), "unicast igmp");
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(47, 9))), "unicast ip 47");
    Frame multicast = Ipv4Frame(17, 7400);
    multicast[0] = 1;
    EXPECT_EQ(NameOf(KindOf(multicast)), "multicast udp 7400");
    Frame arp(42, 0xff);
    arp[12] = 0x08;
    arp[13] = 0x06;
    EXPECT_EQ(NameOf(KindOf(arp)), "multicast arp");
}

TEST(FrameTest, OnlyTheFirstFragmentHasAPort)
{
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(17, 7411, 0x2000))), "unicast udp 7411");
    EXPECT_EQ(NameOf(KindOf(Ipv4Frame(17, 7411, 0x20b9))), "unicast udp fragment");
}

TEST(FrameTest, FramesCutShortAnywhereAreTakenAsFarAsTheyGo)
{
    const Frame whole = Ipv4Frame(17, 7411);
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
    {
        const Frame cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));
        EXPECT_EQ(KindOf(cut).Port, bytes >= EthernetHeader + 24 ? 7411 : 0) << bytes;
        EXPECT_EQ(IpBytes(cut), bytes >= EthernetHeader ? bytes - EthernetHeader : 0);
    }
}

TEST(FrameTest, WhatIsNotIpHasNoIpBytes)
{
    Frame arp(42);
    arp[12] = 0x08;
    arp[13] = 0x06;
    EXPECT_EQ(IpBytes(arp), 0u);
    EXPECT_EQ(IpBytes(Ipv4Frame(17, 1)), 38u);
}

TEST(NodeCountersTest, SentBytesHaveTheOverheadAndIpBytesNeitherThatNorEthernet)
{
    NodeCounters counters;
    counters.OnAir(1s, Ipv4Frame(17, 7411), 100, 3ms);
    EXPECT_EQ(counters.Unicast.Bytes, 152u);
    EXPECT_EQ(counters.IpSent, 38u);
    EXPECT_EQ(counters.AirSecond.Most(), 152u);
    EXPECT_EQ(counters.IpSecond.Most(), 38u);
    EXPECT_EQ(counters.LongestWait, 3ms);
}

TEST(NodeCountersTest, KindsAreBounded)
{
    NodeCounters counters;
    for (std::uint16_t port = 1; port <= 1000; ++port)
    {
        counters.OnAir(1s, Ipv4Frame(17, port), 0, 0ms);
    }
    EXPECT_EQ(counters.Kinds.size(), NodeCounters::MostKinds + 1);
    EXPECT_EQ(counters.Kinds.at(Kind{}).Frames, 1000 - NodeCounters::MostKinds);
}

}  // namespace
}  // namespace Rabit::Radio
