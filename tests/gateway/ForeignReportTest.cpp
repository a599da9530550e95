// The report of a node on its topics of foreign programs.
#include "wire/ForeignReport.h"

#include <gtest/gtest.h>

#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

Gateway::ForeignTopic Chatter()
{
    Gateway::ForeignTopic topic;
    topic.topic = "rt/chatter";
    topic.type = "std_msgs::msg::dds_::String_";
    topic.local = "Chatter";
    topic.state = Gateway::NodeState::STALE;
    topic.reason = "nothing newer than 2 s";
    topic.qos = "best effort, volatile";
    topic.samples = 1234567890123;
    topic.readers = 2;
    return topic;
}

TEST(ForeignReport, HasWhatPeopleLookAt)
{
    Gateway::ForeignTopic written = Chatter();
    written.written = true;
    written.reason.clear();
    const auto topics = ForeignReport::TopicsIn(ForeignReport::TextOf({Chatter(), written}));
    ASSERT_EQ(topics.size(), 2U);
    EXPECT_EQ(topics[0], Chatter());
    EXPECT_EQ(topics[1], written);
}

TEST(ForeignReport, TextOfAProgramCannotBeTakenForAnotherMember)
{
    Gateway::ForeignTopic topic = Chatter();
    topic.reason = "a\tb\nread\x1b[2J";
    const auto topics = ForeignReport::TopicsIn(ForeignReport::TextOf({topic}));
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].reason, "a?b?read?[2J");
}

TEST(ForeignReport, MoreTopicsThanFitAreCutBetweenTwo)
{
    const std::vector<Gateway::ForeignTopic> many(2000, Chatter());
    const std::string text = ForeignReport::TextOf(many);
    EXPECT_LE(text.size(), NodeReports::Largest);
    const auto topics = ForeignReport::TopicsIn(text);
    EXPECT_GT(topics.size(), 200U);
    EXPECT_EQ(topics.back(), Chatter());
}

TEST(ForeignReport, LinesThatMakeNoSenseAreLeftOut)
{
    const std::string good = ForeignReport::TextOf({Chatter()});
    for (const std::string &bad :
         {std::string("\n"), std::string("read\tUP\n"), std::string("\t\t\t\t\t\t\t\t\n"), good.substr(1),
          "read\tAWAY" + good.substr(good.find('\t', 5)), good.substr(0, good.size() - 1) + "\tmore\n",
          std::string(100000, '\t') + "\n"})
    {
        EXPECT_TRUE(ForeignReport::TopicsIn(bad).empty()) << bad.substr(0, 100);
        EXPECT_EQ(ForeignReport::TopicsIn(bad + good).size(), 1U) << bad.substr(0, 100);
    }
    EXPECT_TRUE(ForeignReport::TopicsIn("").empty());
}

}  // namespace
}  // namespace Rabit
