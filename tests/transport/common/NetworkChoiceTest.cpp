// Which of a host's networks a session uses, and which addresses are none for it.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../../NoDescriptors.h"
#include "Networks.h"
#include "common/DuplicateAddresses.h"
#include "common/NetworkChoice.h"

namespace
{

using namespace Rabit;
using testing::ElementsAre;
using testing::IsEmpty;

const HostNetwork Wired = Network(2, "eth0", "10.0.0.1");
const HostNetwork Radio = Network(3, "radio0", "10.1.0.1");

std::vector<std::string> UsableOf(const NetworkChoice &choice)
{
    std::vector<std::string> addresses;
    for (const HostNetwork &network : choice.Usable)
    {
        addresses.push_back(network.Address);
    }
    return addresses;
}

std::vector<std::string> ProblemsOf(const NetworkChoice &choice)
{
    std::vector<std::string> texts;
    for (const SettingsProblem &problem : choice.Problems)
    {
        EXPECT_EQ(problem.Setting, "interfaces");
        EXPECT_FALSE(problem.Impossible);
        texts.push_back(problem.Entry + ": " + problem.Text);
    }
    return texts;
}

NetworkChoice Choose(const std::vector<HostNetwork> &host, const std::vector<std::string> &interfaces = {},
                     std::size_t most = 10)
{
    TransportSettings settings;
    settings.Interfaces = interfaces;
    return ChooseNetworks(host, settings, most);
}

TEST(NetworkChoice, TakesAllButLoopbackIfNoneIsNamed)
{
    const auto choice = Choose({Loopback(), Wired, Radio});
    EXPECT_THAT(UsableOf(choice), ElementsAre("10.0.0.1", "10.1.0.1"));
    EXPECT_THAT(choice.Problems, IsEmpty());
}

TEST(NetworkChoice, TakesLoopbackBesideOthersForNoPeerEither)
{
    TransportSettings settings;
    settings.Peers = {"ground"};
    EXPECT_THAT(UsableOf(ChooseNetworks({Loopback(), Wired}, settings, 10)), ElementsAre("10.0.0.1"));
}

TEST(NetworkChoice, TakesLoopbackIfThereIsNothingElse)
{
    EXPECT_THAT(UsableOf(Choose({Loopback(), WithoutCarrier(Wired)})), ElementsAre("127.0.0.1"));
}

TEST(NetworkChoice, TakesNothingWithoutCarrierOrAddressOrSwitchedOff)
{
    EXPECT_THAT(UsableOf(Choose({WithoutCarrier(Wired), Network(3, "eth1", ""), SwitchedOff(Radio)})),
                IsEmpty());
}

TEST(NetworkChoice, LeavesOutWhatCannotMulticastUnlessThatIsNotNeeded)
{
    const std::vector<HostNetwork> host{WithoutMulticast(Wired), Radio};
    EXPECT_THAT(UsableOf(Choose(host)), ElementsAre("10.1.0.1"));
    TransportSettings settings;
    settings.Peers = {"ground"};
    EXPECT_THAT(UsableOf(ChooseNetworks(host, settings, 10)), ElementsAre("10.0.0.1", "10.1.0.1"));
    settings.Peers.clear();
    settings.Multicast = false;
    EXPECT_THAT(UsableOf(ChooseNetworks(host, settings, 10)), ElementsAre("10.0.0.1", "10.1.0.1"));
}

TEST(NetworkChoice, TakesOnlyWhatIsNamed)
{
    EXPECT_THAT(UsableOf(Choose({Loopback(), Wired, Radio}, {"radio0"})), ElementsAre("10.1.0.1"));
    EXPECT_THAT(UsableOf(Choose({Loopback(), Wired, Radio}, {"10.0.0.1", "lo"})),
                ElementsAre("127.0.0.1", "10.0.0.1"));
    EXPECT_THAT(UsableOf(Choose({Loopback(), WithoutMulticast(Wired)}, {"eth0"})), ElementsAre("10.0.0.1"));
}

TEST(NetworkChoice, SaysByNameWhatIsMissing)
{
    EXPECT_THAT(ProblemsOf(Choose({Wired, WithoutCarrier(Radio), SwitchedOff(Network(4, "eth1", "10.2.0.1")),
                                   Network(5, "eth2", "")},
                                  {"eth0", "radio0", "eth1", "eth2", "radio1"})),
                ElementsAre("radio0: the interface radio0 has no carrier: waiting for it",
                            "eth1: the interface eth1 is down: waiting for it",
                            "eth2: the interface eth2 has no IPv4 address: waiting for one",
                            "radio1: the interface radio1 does not exist: waiting for it"));
}

TEST(NetworkChoice, SaysByNameWhatIsTooMany)
{
    const auto choice = Choose({Wired, Radio}, {}, 1);
    EXPECT_THAT(UsableOf(choice), ElementsAre("10.0.0.1"));
    EXPECT_THAT(
        ProblemsOf(choice),
        ElementsAre("radio0: the interface radio0 is not used, because the backend takes at most 1: name "
                    "those that matter"));
}

TEST(HostNetworks, LoopbackIsListedWithItsMask)
{
    const auto listed = ListHostNetworks();
    ASSERT_TRUE(listed);
    const std::vector<HostNetwork> &networks = *listed;
    const auto loopback = std::find_if(networks.begin(), networks.end(),
                                       [](const HostNetwork &network) { return network.IsCalled("lo"); });
    ASSERT_NE(loopback, networks.end());
    EXPECT_TRUE(loopback->Loopback);
    EXPECT_NE(loopback->Index, 0u);
    EXPECT_TRUE(loopback->IsCalled("127.0.0.1"));
    EXPECT_TRUE(loopback->Contains("127.1.2.3"));
    EXPECT_FALSE(loopback->Contains("10.0.0.1"));
    EXPECT_FALSE(loopback->Contains("ground"));
}

TEST(HostNetworks, ThatCannotBeListedAreNotNone)
{
    const NoDescriptors none;
    EXPECT_FALSE(ListHostNetworks());
}

TEST(DuplicateAddresses, AnAddressThatAPeerOnAnotherNetworkHasTooIsOne)
{
    DuplicateAddresses duplicates;
    duplicates.Look({Wired, Radio}, {{"10.0.0.1", "10.1.0.2"}});
    EXPECT_TRUE(duplicates.Has(Wired));
    EXPECT_FALSE(duplicates.Has(Radio));
}

TEST(DuplicateAddresses, APeerOfThisHostHasNone)
{
    DuplicateAddresses duplicates;
    duplicates.Look({Wired, Radio}, {{"10.0.0.1", "10.1.0.1"}});
    EXPECT_FALSE(duplicates.Has(Wired));
    EXPECT_FALSE(duplicates.Has(Radio));
}

TEST(DuplicateAddresses, APeerThatIsOnNoOtherNetworkProvesNothing)
{
    DuplicateAddresses duplicates;
    duplicates.Look({Wired, Radio}, {{"10.0.0.1", "192.168.0.1"}});
    EXPECT_FALSE(duplicates.Has(Wired));
}

TEST(DuplicateAddresses, StaysOneUntilThisHostHasItNoMore)
{
    DuplicateAddresses duplicates;
    duplicates.Look({Wired, Radio}, {{"10.0.0.1", "10.1.0.2"}});
    duplicates.Look({Wired, Radio}, {});
    EXPECT_TRUE(duplicates.Has(Wired));
    duplicates.Look({Radio}, {});
    duplicates.Look({Wired, Radio}, {});
    EXPECT_FALSE(duplicates.Has(Wired));
}

}  // namespace
