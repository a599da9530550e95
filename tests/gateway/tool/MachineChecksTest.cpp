#include "doctor/MachineChecks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Tool::Doctor
{
namespace
{

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Interface InterfaceOf(const std::string &name, const std::string &address)
{
    Interface one;
    one.Name = name;
    one.Addresses = {address};
    one.IsUp = true;
    one.HasMulticast = true;
    one.Mtu = 1500;
    return one;
}

std::vector<std::string> ProblemsOf(const std::vector<Finding> &findings)
{
    std::vector<std::string> lines;
    for (const Finding &finding : findings)
    {
        if (finding.How == Level::Problem)
        {
            EXPECT_NE(finding.Advice, "") << finding.Text;
            lines.push_back(finding.Subject + ": " + finding.Text + ". " + finding.Advice);
        }
    }
    return lines;
}

TEST(MachineChecks, AnInterfaceThatIsUpWithAnAddressIsGood)
{
    const std::vector<Interface> all{InterfaceOf("eth0", "10.0.0.2")};
    EXPECT_THAT(ProblemsOf(OfInterfaces({}, all)), IsEmpty());
    EXPECT_EQ(OfInterfaces({}, all).front().Text, "10.0.0.2, MTU 1500");
}

TEST(MachineChecks, TheInterfacesOfAllPathsAreUsed)
{
    GatewayConfig config;
    config.Paths = {{.Name = "mesh", .Interfaces = {"wlan0"}}, {.Name = "modem", .Interfaces = {"ppp0"}}};
    const std::vector<Interface> all{InterfaceOf("eth0", "10.0.0.2"), InterfaceOf("wlan0", "10.0.0.3")};
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)),
                ::testing::ElementsAre("interface ppp0: this machine has none. name one of eth0, wlan0"));
    ASSERT_EQ(UsedBy(config, all).size(), 1U);
    EXPECT_EQ(UsedBy(config, all).front().Name, "wlan0");
}

TEST(MachineChecks, AnInterfaceThatIsNamedMustBeThereAndUpWithAnAddress)
{
    GatewayConfig config;
    config.Interfaces = {"wlan0"};
    std::vector<Interface> all{InterfaceOf("eth0", "10.0.0.2")};
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)),
                Contains("interface wlan0: this machine has none. name one of eth0"));
    all.push_back(InterfaceOf("wlan0", "10.0.0.3"));
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), IsEmpty());
    all.back().Addresses.clear();
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), Contains(HasSubstr("it has no IPv4 address")));
    all.back().IsUp = false;
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), Contains(HasSubstr("it is down, or has no carrier")));
}

TEST(MachineChecks, AnAddressNamesAnInterface)
{
    GatewayConfig config;
    config.Interfaces = {"10.0.0.3"};
    const std::vector<Interface> all{InterfaceOf("eth0", "10.0.0.2"), InterfaceOf("wlan0", "10.0.0.3")};
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), IsEmpty());
    ASSERT_EQ(UsedBy(config, all).size(), 1u);
    EXPECT_EQ(UsedBy(config, all)[0].Name, "wlan0");
}

TEST(MachineChecks, InterfacesThatAreUpAndNotNamedAreUnused)
{
    std::vector<Interface> all{InterfaceOf("lo", "127.0.0.1"), InterfaceOf("eth0", "10.0.0.2"),
                               InterfaceOf("eth1", "10.1.0.2")};
    all[0].Index = 1;
    all[1].Index = 2;
    all[2].Index = 3;
    all[2].IsUp = false;
    EXPECT_THAT(UnusedBy({}, all), IsEmpty());
    GatewayConfig config;
    config.Interfaces = {"lo"};
    ASSERT_EQ(UnusedBy(config, all).size(), 1u);
    EXPECT_EQ(UnusedBy(config, all)[0].Name, "eth0");
}

TEST(MachineChecks, LoopbackAloneReachesNobodyUnlessItIsNamed)
{
    std::vector<Interface> all{InterfaceOf("lo", "127.0.0.1")};
    all[0].IsLoopback = true;
    EXPECT_THAT(ProblemsOf(OfInterfaces({}, all)), Contains(HasSubstr("none but loopback is up")));
    GatewayConfig config;
    config.Interfaces = {"lo"};
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), IsEmpty());
}

TEST(MachineChecks, AnInterfaceWithoutMulticastIsToldUnlessNobodyWantsIt)
{
    std::vector<Interface> all{InterfaceOf("eth0", "10.0.0.2")};
    all[0].HasMulticast = false;
    EXPECT_THAT(ProblemsOf(OfInterfaces({}, all)), Contains(HasSubstr("ip link set eth0 multicast on")));
    GatewayConfig config;
    config.Multicast = false;
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), IsEmpty());
}

TEST(MachineChecks, LoopbackNeedsNoFlagForMulticast)
{
    std::vector<Interface> all{InterfaceOf("lo", "127.0.0.1")};
    all[0].IsLoopback = true;
    all[0].HasMulticast = false;
    GatewayConfig config;
    config.Interfaces = {"lo"};
    EXPECT_THAT(ProblemsOf(OfInterfaces(config, all)), IsEmpty());
}

TEST(MachineChecks, DatagramsMustFitTheMtu)
{
    std::vector<Interface> used{InterfaceOf("wlan0", "10.0.0.2")};
    EXPECT_THAT(OfMtu({}, used), IsEmpty());
    used[0].Mtu = 1280;
    EXPECT_THAT(ProblemsOf(OfMtu({}, used)), Contains(HasSubstr("max_datagram: 1252 in each configuration")));
    used[0].Mtu = 576;
    EXPECT_THAT(ProblemsOf(OfMtu({}, used)), Contains(HasSubstr("raise the MTU")));
}

MachineFacts FactsOf(std::uint64_t noRoom, const std::map<int, std::uint64_t> &drops)
{
    MachineFacts facts;
    facts.LargestReceiveBuffer = 212992;
    facts.Udp.NoRoom = noRoom;
    facts.DropsOfPorts = drops;
    return facts;
}

TEST(MachineChecks, SmallBuffersAreAProblemOnceSomethingWasLost)
{
    EXPECT_THAT(ProblemsOf(OfBuffers({}, FactsOf(5, {}), FactsOf(5, {}))), IsEmpty());
    EXPECT_EQ(OfBuffers({}, FactsOf(5, {}), FactsOf(5, {})).front().How, Level::Note);
    EXPECT_THAT(
        ProblemsOf(OfBuffers({}, FactsOf(5, {}), FactsOf(8, {{50000, 3}}))),
        Contains("receive buffers: datagrams came faster than programs of this machine read them: 3 while it "
                 "was looked at; by open sockets port 50000 3. sysctl -w net.core.rmem_max=4194304, and "
                 "start the nodes again"));
}

TEST(MachineChecks, WhatASocketOfTheDomainHasLostBeforeCountsAsWell)
{
    GatewayConfig config;
    config.Domain = 1;
    EXPECT_THAT(ProblemsOf(OfBuffers(config, FactsOf(5, {{7661, 2}}), FactsOf(5, {{7661, 2}}))),
                Contains(HasSubstr("port 7661 2")));
    config.Domain = 0;
    EXPECT_THAT(ProblemsOf(OfBuffers(config, FactsOf(5, {{7661, 2}}), FactsOf(5, {{7661, 2}}))), IsEmpty());
}

TEST(MachineFacts, AreReadFromTheKernelsTables)
{
    const UdpCounters counters = UdpCountersIn(
        "Ip: Forwarding\nIp: 1\nUdp: InDatagrams NoPorts InErrors OutDatagrams RcvbufErrors SndbufErrors\n"
        "Udp: 100 2 7 90 5 3\nUdpLite: InDatagrams\nUdpLite: 9\n");
    EXPECT_EQ(counters.NoRoom, 5u);
    EXPECT_EQ(counters.NotSent, 3u);
    const auto drops = DropsIn(
        "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode "
        "ref pointer drops\n"
        "  100: 00000000:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 22 2 "
        "0000000000000000 12\n"
        "  101: 00000000:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 23 2 "
        "0000000000000000 0\n");
    EXPECT_EQ(drops, (std::map<int, std::uint64_t>{{7400, 12}}));
}

TEST(MachineFacts, OfTextsThatMakeNoSenseAreNone)
{
    for (const char *text :
         {"", "Udp:\nUdp:\n", "Udp: RcvbufErrors\nUdp: x\n", "a:b:c d e f g h i j k l m n o\n"})
    {
        EXPECT_EQ(UdpCountersIn(text).NoRoom, 0u);
        EXPECT_THAT(DropsIn(text), IsEmpty());
    }
}

}  // namespace
}  // namespace Rabit::Tool::Doctor
