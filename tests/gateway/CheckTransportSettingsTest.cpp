#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/ConfigError.h>

#include <memory>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

// A transport whose check returns what the test sets.
class FindingTransport : public Transport
{
public:
    std::string Name() const override { return "finding"; }
    std::unique_ptr<TransportSession> Open(const TransportSettings &, PeerHandler) override
    {
        return nullptr;
    }
    std::vector<SettingsProblem> Check(const TransportSettings &settings) const override
    {
        Checked = settings;
        return Found;
    }
    std::vector<SettingsProblem> Found;
    mutable TransportSettings Checked;
};

class CheckTransportSettingsTest : public ::testing::Test
{
protected:
    CheckTransportSettingsTest()
    {
        config.Node = "uav1";
        config.Interfaces = {"wlan0"};
        config.File = "uav1.yaml";
        config.Lines = {{"interfaces", 3}, {"peers", 4}};
    }
    GatewayConfig config;
    FindingTransport transport;
};

TEST_F(CheckTransportSettingsTest, WhatCanNeverWorkIsRefusedWithFileAndLine)
{
    transport.Found = {{"interfaces", "wlan0", "there is no wlan0 yet", false},
                       {"peers", "10.0.0", "the peer 10.0.0 is no address", true}};
    try
    {
        CheckTransportSettings(config, transport);
        FAIL() << "no error";
    }
    catch (const ConfigError &error)
    {
        EXPECT_STREQ(error.what(), "uav1.yaml:4: the peer 10.0.0 is no address");
    }
}

TEST_F(CheckTransportSettingsTest, WhatIsOnlyMissingNowIsSaidWithFileAndLine)
{
    transport.Found = {{"interfaces", "wlan0", "there is no wlan0 yet", false}};
    EXPECT_THAT(CheckTransportSettings(config, transport),
                ::testing::ElementsAre("uav1.yaml:3: there is no wlan0 yet"));
    EXPECT_EQ(transport.Checked.Interfaces, config.Interfaces);
}

TEST_F(CheckTransportSettingsTest, NothingIsSaidOfGoodSettings)
{
    EXPECT_THAT(CheckTransportSettings(config, transport), ::testing::IsEmpty());
}

}  // namespace
}  // namespace Rabit
