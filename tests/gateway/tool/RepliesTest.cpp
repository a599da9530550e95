// Which message of a queue answers what the program has sent, and whether it is as expected.
#include "Replies.h"

#include <gtest/gtest.h>
#include <rabit/dynamic/DynamicType.h>

namespace Rabit::Tool::Reply
{
namespace
{

constexpr const char *Text = R"(
enum Stage { ACCEPTED, DECLINED };
@final struct Order { unsigned long id; string<20> reply_to; double latitude_deg; };
@final struct Ack { unsigned long id; Stage stage; string reason; };
@final struct Note { string text; };
)";

std::shared_ptr<const DynamicType> Type(const std::string &name)
{
    return DynamicType::Parse(Text, name).Type;
}

DynamicMessage Order(const std::string &json)
{
    DynamicMessage order(Type("Order"));
    EXPECT_EQ(order.SetJson(json), "");
    return order;
}

TEST(Reply, AMessageAsksForItsAnswerInTheQueueOfThisProgram)
{
    DynamicMessage order = Order(R"({"latitude_deg": 47.5})");
    EXPECT_EQ(Ask(order, "tool/Replies", 17), "");
    const Json value = Json::parse(order.ToJson());
    EXPECT_EQ(value["reply_to"], "tool/Replies");
    EXPECT_EQ(value["id"], 17);
    EXPECT_EQ(value["latitude_deg"], 47.5);
}

TEST(Reply, ANumberThatThePersonGaveStays)
{
    DynamicMessage order = Order(R"({"id": 5})");
    EXPECT_EQ(Ask(order, "tool/Replies", 17), "");
    EXPECT_EQ(Json::parse(order.ToJson())["id"], 5);
}

TEST(Reply, AMessageThatCannotAskForAnAnswerIsRefused)
{
    DynamicMessage note(Type("Note"));
    EXPECT_EQ(Ask(note, "tool/Replies", 1), "`Note` has no text `reply_to`: it cannot ask for an answer");
    DynamicMessage other = Order(R"({"reply_to": "ground/Commands"})");
    EXPECT_EQ(Ask(other, "tool/Replies", 1),
              "`reply_to` names `ground/Commands`, where the answer goes; --reply needs it empty");
    DynamicMessage order = Order("{}");
    EXPECT_NE(Ask(order, "a.name.that.is.too.long/Replies", 1), "") << "reply_to holds 20";
}

TEST(Reply, AnAnswerHasTheNumberOfTheMessage)
{
    EXPECT_TRUE(IsTo(Json{{"id", 5}}, Json{{"id", 5}}));
    EXPECT_FALSE(IsTo(Json{{"id", 6}}, Json{{"id", 5}}));
    EXPECT_TRUE(IsTo(Json{{"id", "5"}}, Json{{"id", 5}})) << "one of the two may be a number of 64 bits";
    EXPECT_TRUE(IsTo(Json{{"text", "yes"}}, Json{{"id", 5}}));
    EXPECT_FALSE(IsTo(Json(), Json{{"id", 5}})) << "it is no message";
}

TEST(Reply, OnlyTheMembersThatAPersonNamesAreExpected)
{
    Json expected;
    EXPECT_EQ(Expect(Type("Ack"), R"({"stage": "DECLINED"})", expected), "");
    EXPECT_TRUE(Has(Json{{"id", 5}, {"stage", "DECLINED"}, {"reason", "no"}}, expected));
    EXPECT_FALSE(Has(Json{{"id", 5}, {"stage", "ACCEPTED"}, {"reason", ""}}, expected));
    EXPECT_FALSE(Has(Json{{"id", 5}}, expected));
    EXPECT_NE(Expect(Type("Ack"), R"({"stag": "DECLINED"})", expected), "");
    EXPECT_TRUE(Has(Json{{"id", 5}}, Json::object()));
}

}  // namespace
}  // namespace Rabit::Tool::Reply
