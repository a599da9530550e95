#include <gtest/gtest.h>

#include "common/OwnNetworks.h"

namespace Rabit
{
namespace
{

HostNetwork Network(const std::string &address, std::uint32_t mask)
{
    HostNetwork network;
    network.Address = address;
    network.Mask = mask;
    return network;
}

const std::vector<HostNetwork> All = {Network("10.77.0.1", 0xffff0000), Network("10.78.0.1", 0xffff0000),
                                      Network("10.8.0.2", 0xffffffff), Network("", 0)};

TEST(OwnNetworks, WithoutNamedInterfacesEverythingMayCome)
{
    EXPECT_TRUE(OwnNetworks({}, All).MayComeFrom({192, 168, 0, 1}));
}

TEST(OwnNetworks, FromTheNetworkOfAnotherInterfaceNothingMayCome)
{
    const OwnNetworks networks({"10.77.0.1"}, All);
    EXPECT_TRUE(networks.MayComeFrom({10, 77, 3, 9}));
    EXPECT_FALSE(networks.MayComeFrom({10, 78, 0, 2}));
    EXPECT_FALSE(networks.MayComeFrom({10, 8, 0, 2}));
}

TEST(OwnNetworks, FromANetworkBehindARouterEverythingMayCome)
{
    EXPECT_TRUE(OwnNetworks({"10.77.0.1"}, All).MayComeFrom({192, 168, 0, 1}));
}

TEST(OwnNetworks, ANetworkOfTwoInterfacesIsOwn)
{
    const std::vector<HostNetwork> same = {Network("10.77.0.1", 0xffff0000),
                                           Network("10.77.0.2", 0xffff0000)};
    EXPECT_TRUE(OwnNetworks({"10.77.0.1"}, same).MayComeFrom({10, 77, 3, 9}));
}

}  // namespace
}  // namespace Rabit
