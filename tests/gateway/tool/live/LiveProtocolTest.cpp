#include "live/LiveProtocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace Rabit::Tool::LiveProtocol
{
namespace
{

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(LiveProtocol, SpeaksTheProtocolThatIsAskedFor)
{
    EXPECT_EQ(ChosenOf("foxglove.websocket.v1"), "foxglove.websocket.v1");
    EXPECT_EQ(ChosenOf("other, foxglove.sdk.v1 ,x"), "foxglove.sdk.v1");
    EXPECT_FALSE(ChosenOf("foxglove.websocket.v2").has_value());
    EXPECT_FALSE(ChosenOf("").has_value());
    EXPECT_FALSE(ChosenOf(" , ,").has_value());
}

TEST(LiveProtocol, OffersNothingThatCanBeSent)
{
    const json info = json::parse(ServerInfo("rabit", "7"));
    EXPECT_EQ(info["op"], "serverInfo");
    EXPECT_EQ(info["capabilities"], json::array());
    EXPECT_EQ(info["sessionId"], "7");
}

TEST(LiveProtocol, AdvertisesChannelsWithTheirSchemas)
{
    const Channel channel{
        .Id = 3, .Topic = "uav1/Pose", .SchemaName = "Uav::Pose", .SchemaText = "struct Pose {};"};
    const json said = json::parse(Advertise({&channel, 1}));
    ASSERT_EQ(said["channels"].size(), 1u);
    const json &one = said["channels"][0];
    EXPECT_EQ(one["id"], 3);
    EXPECT_EQ(one["topic"], "uav1/Pose");
    EXPECT_EQ(one["encoding"], "cdr");
    EXPECT_EQ(one["schemaName"], "Uav::Pose");
    EXPECT_EQ(one["schema"], "struct Pose {};");
    EXPECT_EQ(one["schemaEncoding"], "omgidl");
}

TEST(LiveProtocol, TextThatIsNoUtf8IsStillJson)
{
    EXPECT_TRUE(json::accept(Status(Level::Warning, "\xff\x1b[2J")));
}

TEST(LiveProtocol, AValueHasItsSubscriptionAndTimeInLittleEndian)
{
    const std::uint8_t bytes[] = {9, 8};
    EXPECT_THAT(MessageData(0x01020304, 0x1122334455667788, bytes),
                ElementsAre(1, 4, 3, 2, 1, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 9, 8));
}

TEST(LiveProtocol, ReadsWhatAViewerSubscribesTo)
{
    const Request request = ReadRequest(
        R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":4294967295}]})");
    ASSERT_EQ(request.What, Request::Kind::Subscribe);
    ASSERT_EQ(request.Subscriptions.size(), 2u);
    EXPECT_EQ(request.Subscriptions[1].Id, 1u);
    EXPECT_EQ(request.Subscriptions[1].Channel, 4294967295u);
}

TEST(LiveProtocol, ReadsWhatAViewerWantsNoMore)
{
    const Request request = ReadRequest(R"({"op":"unsubscribe","subscriptionIds":[1,2]})");
    ASSERT_EQ(request.What, Request::Kind::Unsubscribe);
    EXPECT_THAT(request.Ids, ElementsAre(1, 2));
}

TEST(LiveProtocol, SaysOfAnythingElseWhatIsNotHad)
{
    const Request request = ReadRequest(R"({"op":"advertise","channels":[]})");
    EXPECT_EQ(request.What, Request::Kind::Unknown);
    EXPECT_THAT(request.Problem, HasSubstr("`advertise`"));
}

TEST(LiveProtocol, TakesNothingThatIsNotSound)
{
    for (const char *text :
         {"", "[]", "{", "null", R"({"op":7})", R"({"op":"subscribe"})",
          R"({"op":"subscribe","subscriptions":[7]})", R"({"op":"subscribe","subscriptions":[{"id":1}]})",
          R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
          R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
          R"({"op":"unsubscribe","subscriptionIds":["1"]})"})
    {
        EXPECT_EQ(ReadRequest(text).What, Request::Kind::Unknown) << text;
        EXPECT_FALSE(ReadRequest(text).Problem.empty()) << text;
    }
}

}  // namespace
}  // namespace Rabit::Tool::LiveProtocol
