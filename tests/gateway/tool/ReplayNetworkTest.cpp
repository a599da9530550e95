#include "ReplayNetwork.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class ReplayNetworkTest : public ::testing::Test
{
protected:
    ReplayNetworkTest()
    {
        // Settings as in a file of the fleet that flies.
        config.Domain = 7;
        config.Interfaces = {"wlan0"};
        config.Peers = {"10.0.0.2"};
        config.BackendConfig = "vendor.xml";
    }

    GatewayConfig config;
    CommonOptions options;
};

TEST_F(ReplayNetworkTest, IsLoopbackAloneWhateverAFileSays)
{
    const GatewayConfig played = ReplayNetwork(config, options, {"7"});
    EXPECT_THAT(played.Interfaces, ElementsAre("127.0.0.1"));
    EXPECT_THAT(played.Peers, IsEmpty());
    EXPECT_EQ(played.BackendConfig, "");
    EXPECT_EQ(played.Domain, 7);
}

TEST_F(ReplayNetworkTest, TheDomainOfTheRecordingIsNotPlayedIntoByItsNumber)
{
    options.Node.Domain = 7;
    EXPECT_THAT(ReplayNetwork(config, options, {"7"}).Interfaces, ElementsAre("127.0.0.1"));
    EXPECT_THAT(ReplayNetwork(config, options, {"3", "7"}).Interfaces, ElementsAre("127.0.0.1"));
    EXPECT_THAT(ReplayNetwork(config, options, {}).Interfaces, ElementsAre("127.0.0.1"))
        << "nobody knows where it was recorded";
}

TEST_F(ReplayNetworkTest, InAnotherDomainItMayLeaveTheMachine)
{
    options.Node.Domain = 42;
    const GatewayConfig played = ReplayNetwork(config, options, {"7"});
    EXPECT_THAT(played.Interfaces, ElementsAre("wlan0"));
    EXPECT_THAT(played.Peers, ElementsAre("10.0.0.2"));
}

TEST_F(ReplayNetworkTest, OnAnInterfaceThatIsNamedToo)
{
    options.Interfaces = {"wlan0"};
    EXPECT_THAT(ReplayNetwork(config, options, {"7"}).Interfaces, ElementsAre("wlan0"));
}

}  // namespace
}  // namespace Rabit::Tool
