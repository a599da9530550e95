#include "PageRequest.h"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace
{
using Json = nlohmann::json;
using Ground::ParsePageRequest;
using testing::HasSubstr;

const Json Goto = {{"type", "order"},      {"ref", 7},           {"kind", "goto"},    {"node", "uav1"},
                   {"latitude_deg", 47.5}, {"longitude_deg", 8}, {"altitude_m", 510}, {"speed_mps", 12.5}};
const Json Area = {{"type", "area"},     {"ref", 8},        {"latitude_deg", 47.5},
                   {"longitude_deg", 8}, {"north_m", 400},  {"east_m", 600},
                   {"altitude_m", 510},  {"speed_mps", 16}, {"lane_m", 60}};

Json With(Json request, const char *field, const Json &value)
{
    request[field] = value;
    return request;
}
Json Without(Json request, const char *field)
{
    request.erase(field);
    return request;
}
std::string RefusalOf(const Json &request)
{
    return ParsePageRequest(request.dump()).Refusal;
}

TEST(PageRequest, TakesAGoto)
{
    const auto request = ParsePageRequest(Goto.dump());
    EXPECT_EQ(request.Refusal, "");
    EXPECT_EQ(request.Ref, 7);
    const auto &order = std::get<Ground::Order>(request.Wish);
    EXPECT_EQ(order.kind, Ground::OrderKind::ORDER_GOTO);
    EXPECT_EQ(order.node, "uav1");
    EXPECT_EQ(order.latitude_deg, 47.5);
    EXPECT_EQ(order.longitude_deg, 8);
    EXPECT_EQ(order.altitude_m, 510);
    EXPECT_EQ(order.speed_mps, 12.5F);
}

TEST(PageRequest, TakesHomeAndSearchWithoutAPoint)
{
    const Json home = {{"type", "order"}, {"ref", 0}, {"kind", "home"}, {"node", "uav-1.b_2"}};
    EXPECT_EQ(std::get<Ground::Order>(ParsePageRequest(home.dump()).Wish).kind,
              Ground::OrderKind::ORDER_HOME);
    EXPECT_EQ(std::get<Ground::Order>(ParsePageRequest(With(home, "kind", "search").dump()).Wish).kind,
              Ground::OrderKind::ORDER_SEARCH);
    EXPECT_THAT(RefusalOf(With(home, "altitude_m", 1)), HasSubstr("not known"));
}

TEST(PageRequest, TakesASearchAreaAndAQuestionForTheClock)
{
    const auto request = ParsePageRequest(Area.dump());
    EXPECT_EQ(request.Ref, 8);
    const auto &area = std::get<Uav::SearchArea>(request.Wish);
    EXPECT_EQ(area.north_m, 400);
    EXPECT_EQ(area.east_m, 600);
    EXPECT_EQ(area.lane_m, 60);
    EXPECT_EQ(area.number, 0u) << "whoever publishes it counts";
    EXPECT_EQ(std::get<Ground::ClockRequest>(ParsePageRequest(R"({"type":"clock","page_s":1.5})").Wish).PageS,
              1.5);
}

TEST(PageRequest, RefusesEveryMissingField)
{
    for (const Json &whole : {Goto, Area})
        for (const auto &[field, value] : whole.items())
            EXPECT_THAT(RefusalOf(Without(whole, field.c_str())), HasSubstr("'" + field + "'")) << field;
}

TEST(PageRequest, RefusesEveryFieldOfAnotherType)
{
    for (const Json &whole : {Goto, Area})
        for (const auto &[field, value] : whole.items())
            for (const Json &wrong : {Json(nullptr), Json(true), Json::array({1}), Json::object(),
                                      value.is_string() ? Json(1) : Json("1")})
                EXPECT_THAT(RefusalOf(With(whole, field.c_str(), wrong)), HasSubstr("'" + field + "'"))
                    << field << " " << wrong;
}

TEST(PageRequest, RefusesWhatIsOutOfRange)
{
    struct Range
    {
        const char *Field;
        double Below;
        double Above;
    };
    for (const Range &range : {Range{"latitude_deg", -90.1, 90.1}, Range{"longitude_deg", -180.1, 180.1},
                               Range{"altitude_m", -501, 10001}, Range{"speed_mps", 0, 50.1}})
    {
        EXPECT_THAT(RefusalOf(With(Goto, range.Field, range.Below)), HasSubstr(range.Field));
        EXPECT_THAT(RefusalOf(With(Goto, range.Field, range.Above)), HasSubstr(range.Field));
        EXPECT_THAT(RefusalOf(With(Area, range.Field, range.Below)), HasSubstr(range.Field));
    }
    for (const Range &range :
         {Range{"north_m", 9.9, 20001}, Range{"east_m", 9.9, 20001}, Range{"lane_m", 4.9, 1001}})
    {
        EXPECT_THAT(RefusalOf(With(Area, range.Field, range.Below)), HasSubstr(range.Field));
        EXPECT_THAT(RefusalOf(With(Area, range.Field, range.Above)), HasSubstr(range.Field));
    }
    EXPECT_THAT(RefusalOf(With(Goto, "ref", -1)), HasSubstr("'ref'"));
    EXPECT_THAT(RefusalOf(With(Goto, "ref", 1.5)), HasSubstr("'ref'"));
    EXPECT_THAT(RefusalOf(With(Goto, "kind", "land")), HasSubstr("'kind'"));
    EXPECT_THAT(RefusalOf(With(Goto, "type", "shell")), HasSubstr("'type'"));
    for (const char *name : {"", "*", "uav1/x", "uav 1", "<b>", "\xC3\xA4"})
        EXPECT_THAT(RefusalOf(With(Goto, "node", name)), HasSubstr("'node'")) << name;
    EXPECT_THAT(RefusalOf(With(Goto, "node", std::string(65, 'x'))), HasSubstr("'node'"));
}

TEST(PageRequest, RefusesUnknownFields)
{
    EXPECT_THAT(RefusalOf(With(Goto, "reply_to", "x")), HasSubstr("not known"));
    EXPECT_THAT(RefusalOf(With(Area, "number", 5)), HasSubstr("not known"));
}

TEST(PageRequest, RefusesWhatIsNoJsonObject)
{
    for (const std::string text :
         {"", "x", "null", "1", "[]", "\"order\"", "{", "{}x", "{\"type\":\"clock\",\"page_s\":1e999}",
          "{\"type\":\"clock\",\"page_s\":NaN}", "\xFF"})
    {
        const auto request = ParsePageRequest(text);
        EXPECT_NE(request.Refusal, "") << text;
        EXPECT_TRUE(std::holds_alternative<std::monostate>(request.Wish)) << text;
    }
    EXPECT_NE(ParsePageRequest(std::string(4096, '[')).Refusal, "");
}

TEST(PageRequest, TellsThePageWhichOneWasRefused)
{
    const auto request = ParsePageRequest(With(Goto, "speed_mps", 1000).dump());
    EXPECT_EQ(Json::parse(Ground::RefusedReply(request.Ref, request.Refusal)),
              Json({{"type", "reply"},
                    {"ref", 7},
                    {"ok", false},
                    {"reason", "'speed_mps' must be from 0.1 to 50, not 1000"}}));
    EXPECT_EQ(Json::parse(Ground::AcceptedReply(7)), Json({{"type", "reply"}, {"ref", 7}, {"ok", true}}));
    EXPECT_EQ(Json::parse(Ground::ClockReply({1.5}, 20)),
              Json({{"type", "clock"}, {"page_s", 1.5}, {"server_s", 20}}));
}

}  // namespace
