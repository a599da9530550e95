#include "live/PanelMapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace Rabit::Tool
{
namespace
{

using nlohmann::json;
using testing::HasSubstr;

constexpr std::uint64_t Time = 1'700'000'000'500'000'000;

PanelRule PoseRule()
{
    return {.Message = "Pose",
            .Schema = PanelRule::Panel::LocationFix,
            .Fields = {{"latitude", "at.0"}, {"longitude", "at.1"}, {"altitude", "height.m"}}};
}

TEST(PanelMapping, MakesAPlaceOnAMapOfAPose)
{
    const PanelMapping mapping(PoseRule());
    const auto shown = mapping.Show("uav1", R"({"at":[47.5,8.25],"height":{"m":500}})", Time);
    ASSERT_TRUE(shown.has_value());
    const json place = json::parse(*shown);
    EXPECT_EQ(place["latitude"], 47.5);
    EXPECT_EQ(place["longitude"], 8.25);
    EXPECT_EQ(place["altitude"], 500);
    EXPECT_EQ(place["frame_id"], "uav1");
    EXPECT_EQ(place["timestamp"]["sec"], 1'700'000'000);
    EXPECT_EQ(place["timestamp"]["nsec"], 500'000'000);
}

TEST(PanelMapping, IsAChannelOfItsOwnWithTheSchemaThatViewersKnow)
{
    const LiveProtocol::Channel channel = PanelMapping(PoseRule()).ChannelFor("uav1");
    EXPECT_EQ(channel.Topic, "uav1/Pose/LocationFix");
    EXPECT_EQ(channel.Encoding, "json");
    EXPECT_EQ(channel.SchemaName, "foxglove.LocationFix");
    EXPECT_EQ(channel.SchemaEncoding, "jsonschema");
    const json schema = json::parse(channel.SchemaText);
    EXPECT_EQ(schema["properties"]["latitude"]["type"], "number");
    EXPECT_EQ(schema["properties"]["timestamp"]["properties"]["nsec"]["type"], "integer");
}

TEST(PanelMapping, AFieldThatIsNotThereIsNamed)
{
    const PanelMapping mapping(PoseRule());
    for (const char *value : {"{}", R"({"at":[47.5]})", R"({"at":7})", "no json", ""})
    {
        EXPECT_FALSE(mapping.Show("uav1", value, Time).has_value()) << value;
    }
    EXPECT_THAT(mapping.WhyNot(R"({"at":[47.5]})"), HasSubstr("no `at.1` for `longitude`"));
}

TEST(PanelMapping, ATextIsNoNumber)
{
    const PanelMapping mapping(PoseRule());
    EXPECT_THAT(mapping.WhyNot(R"({"at":["north",8]})"), HasSubstr("`at.0`, for `latitude`, is no number"));
}

TEST(PanelMapping, APictureHasItsBytesAndAFormatThatIsNamed)
{
    const PanelMapping mapping({.Message = "View",
                                .Schema = PanelRule::Panel::CompressedImage,
                                .Fields = {{"data", "jpeg"}, {"format", "=jpeg"}}});
    const json picture = json::parse(*mapping.Show("uav1", R"({"jpeg":"/9j/"})", Time));
    EXPECT_EQ(picture["data"], "/9j/");
    EXPECT_EQ(picture["format"], "jpeg");
    const json schema = json::parse(mapping.ChannelFor("uav1").SchemaText);
    EXPECT_EQ(schema["properties"]["data"]["contentEncoding"], "base64");
}

TEST(PanelMapping, ALineOfALogHasALevelAndAName)
{
    const PanelMapping mapping(
        {.Message = "MissionState", .Schema = PanelRule::Panel::Log, .Fields = {{"message", "text"}}});
    const json line = json::parse(*mapping.Show("uav1", R"({"text":"searching"})", Time));
    EXPECT_EQ(line["message"], "searching");
    EXPECT_EQ(line["name"], "uav1");
    EXPECT_EQ(line["level"], 2);
}

TEST(PanelMapping, ANumberMayBeNamed)
{
    const PanelMapping mapping({.Message = "MissionState",
                                .Schema = PanelRule::Panel::Log,
                                .Fields = {{"message", "text"}, {"level", "=4"}}});
    EXPECT_EQ(json::parse(*mapping.Show("uav1", R"({"text":""})", Time))["level"], 4);
}

}  // namespace
}  // namespace Rabit::Tool
