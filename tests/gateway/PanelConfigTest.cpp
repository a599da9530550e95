// The section `foxglove` of a configuration.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace Rabit
{
namespace
{

using ::testing::EndsWith;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

class PanelConfigTest : public ::testing::Test
{
protected:
    ~PanelConfigTest() override { std::filesystem::remove(_file); }

    void Write(const std::string &entry) const
    {
        std::ofstream(_file) << "node: ground\nfoxglove:\n  - {" << entry << "}\n";
    }
    std::string Refusal(const std::string &entry) const
    {
        Write(entry);
        try
        {
            LoadGatewayConfig(_file.string());
        }
        catch (const ConfigError &error)
        {
            return error.what();
        }
        return "no error";
    }

    const std::filesystem::path _file = std::filesystem::path(::testing::TempDir()) /
                                        ("rabit-panels-" + std::to_string(::getpid()) + ".yaml");
};

TEST_F(PanelConfigTest, ReadsWhatPanelsAreMadeOf)
{
    Write("message: Pose, as: foxglove.LocationFix, fields: {latitude: latitude_deg, longitude: at.lon}");
    for (const GatewayConfig &config : {LoadGatewayConfig(_file.string()), LoadNetworkConfig(_file.string())})
    {
        ASSERT_EQ(config.Panels.size(), 1u);
        const PanelRule &rule = config.Panels.front();
        EXPECT_EQ(rule.Message, "Pose");
        EXPECT_EQ(rule.Schema, PanelRule::Panel::LocationFix);
        EXPECT_EQ(rule.Line, 3);
        EXPECT_THAT(rule.Fields,
                    UnorderedElementsAre(Pair("latitude", "latitude_deg"), Pair("longitude", "at.lon")));
    }
}

TEST_F(PanelConfigTest, ASchemaThatPanelsDoNotKnowIsRefused)
{
    EXPECT_THAT(Refusal("message: Pose, as: foxglove.LocationFixx, fields: {latitude: a, longitude: b}"),
                EndsWith("did you mean `foxglove.LocationFix`?"));
}

TEST_F(PanelConfigTest, AFieldThatTheSchemaDoesNotHaveIsRefused)
{
    EXPECT_THAT(
        Refusal("message: Pose, as: foxglove.LocationFix, fields: {latitud: a, longitude: b}"),
        EndsWith(":3: unknown key `latitud` in `fields` of foxglove.LocationFix; did you mean `latitude`?"));
}

TEST_F(PanelConfigTest, AFieldThatThePanelNeedsIsRequired)
{
    EXPECT_NE(Refusal("message: Pose, as: foxglove.LocationFix, fields: {latitude: a}").find("`longitude`"),
              std::string::npos);
    EXPECT_NE(Refusal("message: Pose, as: foxglove.LocationFix").find("`fields`"), std::string::npos);
}

}  // namespace
}  // namespace Rabit
