// Which programs' writers and readers a foreign topic matches, and the reasons given for the others.
#include "foreign/ForeignMatch.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

ForeignRule Read()
{
    ForeignRule rule;
    rule.Topic = "chatter";
    rule.Type = "std_msgs::msg::String";
    rule.Local = "Chatter";
    rule.Names = ForeignRule::WireNames::Ros2;
    return rule;
}

ForeignRule Written()
{
    ForeignRule rule = Read();
    rule.Way = ForeignRule::Direction::Publish;
    return rule;
}

RemoteEndpoint Writer(Reliability reliability = Reliability::Reliable,
                      Durability durability = Durability::Volatile)
{
    return {.IsWriter = true,
            .Topic = "rt/chatter",
            .Type = "std_msgs::msg::dds_::String_",
            .Reliability = reliability,
            .Durability = durability};
}

RemoteEndpoint Reader(Reliability reliability = Reliability::BestEffort,
                      Durability durability = Durability::Volatile)
{
    RemoteEndpoint reader = Writer(reliability, durability);
    reader.IsWriter = false;
    return reader;
}

std::string WhyNone(const ForeignRule &rule, const std::vector<RemoteEndpoint> &endpoints,
                    const std::vector<std::string> &topics = {},
                    const std::vector<std::string> &interfaces = {})
{
    bool isMismatch = false;
    const TopicQos ours = rule.Way == ForeignRule::Direction::Subscribe
                              ? ForeignMatch::ReaderQos(rule, endpoints, ForeignMatch::FirstReaderQos(rule))
                              : ForeignMatch::WriterQos(rule);
    const std::string why = ForeignMatch::WhyNone(rule, ours, endpoints, topics, {7, interfaces}, isMismatch);
    return why + (isMismatch ? " (mismatch)" : "");
}

std::string AsFound(const std::vector<RemoteEndpoint> &endpoints, const ForeignRule &rule = Read())
{
    const TopicQos qos = ForeignMatch::ReaderQos(rule, endpoints, ForeignMatch::FirstReaderQos(rule));
    return ForeignMatch::QosText(qos.Reliability, qos.Durability);
}

TEST(ForeignMatch, AReaderAsksForLittleWhileNobodyWrites)
{
    EXPECT_EQ(AsFound({}), "best effort, volatile");
    EXPECT_EQ(AsFound({Reader(Reliability::Reliable)}), "best effort, volatile");
}

TEST(ForeignMatch, AReaderIntoAQueueExpectsReliableWriters)
{
    ForeignRule rule = Read();
    rule.Each = ForeignRule::Delivery::Queue;
    EXPECT_EQ(AsFound({}, rule), "reliable, volatile");
    EXPECT_EQ(AsFound({Writer(Reliability::BestEffort)}, rule), "best effort, volatile");
}

TEST(ForeignMatch, AReaderAsksForWhatAllWritersOffer)
{
    using enum Reliability;
    using enum Durability;
    EXPECT_EQ(AsFound({Writer(Reliable, Volatile)}), "reliable, volatile");
    EXPECT_EQ(AsFound({Writer(Reliable, TransientLocal)}), "reliable, transient local");
    EXPECT_EQ(AsFound({Writer(Reliable, TransientLocal), Writer(Reliable, Volatile)}), "reliable, volatile");
    EXPECT_EQ(AsFound({Writer(Reliable, TransientLocal), Writer(BestEffort, TransientLocal)}),
              "best effort, volatile");
}

TEST(ForeignMatch, AWriterWithoutRepairHasNoHistoryToGive)
{
    EXPECT_EQ(AsFound({Writer(Reliability::BestEffort, Durability::TransientLocal)}),
              "best effort, volatile");
}

TEST(ForeignMatch, AReaderHeedsNeitherNodesNorOtherTypes)
{
    RemoteEndpoint node = Writer(Reliability::BestEffort);
    node.Node = "uav2";
    RemoteEndpoint other = Writer(Reliability::BestEffort);
    other.Type = "Other";
    EXPECT_EQ(AsFound({Writer(), node, other}), "reliable, volatile");
}

TEST(ForeignMatch, WhatTheRuleSaysHolds)
{
    ForeignRule rule = Read();
    rule.Reliability = Reliability::Reliable;
    rule.Durability = Durability::TransientLocal;
    EXPECT_EQ(AsFound({Writer(Reliability::BestEffort)}, rule), "reliable, transient local");
}

TEST(ForeignMatch, NamesTheQosThatDoesNotFitATopicThatIsRead)
{
    ForeignRule rule = Read();
    rule.Reliability = Reliability::Reliable;
    EXPECT_EQ(WhyNone(rule, {Writer(Reliability::BestEffort)}),
              "a program that writes `rt/chatter` is best effort, this node asks for reliable (mismatch)");
    rule.Durability = Durability::TransientLocal;
    EXPECT_EQ(
        WhyNone(rule, {Writer(Reliability::Reliable, Durability::Volatile)}),
        "a program that writes `rt/chatter` is volatile, this node asks for transient local (mismatch)");
}

TEST(ForeignMatch, NamesTheQosThatDoesNotFitATopicThatIsWritten)
{
    ForeignRule rule = Written();
    rule.Reliability = Reliability::BestEffort;
    EXPECT_EQ(WhyNone(rule, {Reader(Reliability::Reliable)}),
              "a program that reads `rt/chatter` asks for reliable, this node offers best effort (mismatch)");
    EXPECT_EQ(
        WhyNone(Written(), {Reader(Reliability::Reliable, Durability::TransientLocal)}),
        "a program that reads `rt/chatter` asks for transient local, this node offers volatile (mismatch)");
}

TEST(ForeignMatch, NamesADeadlineLivelinessAndOwnershipThatAReaderAsksFor)
{
    RemoteEndpoint due = Reader();
    due.HasDeadline = true;
    EXPECT_EQ(WhyNone(Written(), {due}),
              "a program that reads `rt/chatter` asks for a deadline, this node offers none (mismatch)");
    RemoteEndpoint live = Reader();
    live.HasLiveliness = true;
    EXPECT_EQ(
        WhyNone(Written(), {live}),
        "a program that reads `rt/chatter` asks for a liveliness with a lease or by hand, this node offers "
        "none (mismatch)");
    RemoteEndpoint exclusive = Reader();
    exclusive.IsExclusive = true;
    EXPECT_EQ(
        WhyNone(Written(), {exclusive}),
        "a program that reads `rt/chatter` asks for exclusive ownership, this node offers shared ownership "
        "(mismatch)");
}

TEST(ForeignMatch, AWriterMayHaveADeadlineAndLivelinessButNoExclusiveOwnership)
{
    RemoteEndpoint writer = Writer();
    writer.HasDeadline = true;
    writer.HasLiveliness = true;
    const TopicQos ours = ForeignMatch::FirstReaderQos(Read());
    EXPECT_EQ(ForeignMatch::WhyNot(Read(), ours, writer), "");
    writer.IsExclusive = true;
    EXPECT_EQ(
        ForeignMatch::WhyNot(Read(), ours, writer),
        "a program that writes `rt/chatter` is of exclusive ownership, this node asks for shared ownership");
}

TEST(ForeignMatch, NamesTheOtherTypeAndThePartition)
{
    RemoteEndpoint other = Writer();
    other.Type = "std_msgs::msg::String";
    EXPECT_EQ(WhyNone(Read(), {other}),
              "a program writes `rt/chatter` as `std_msgs::msg::String`, this node reads it as "
              "`std_msgs::msg::dds_::String_` (mismatch)");
    RemoteEndpoint elsewhere = Writer();
    elsewhere.Partitions = {"lab"};
    EXPECT_EQ(
        WhyNone(Read(), {elsewhere}),
        "a program writes `rt/chatter` in the partition `lab`, this node in the default one (mismatch)");
}

TEST(ForeignMatch, SaysThatNobodyWritesItAndWhatIsThereInstead)
{
    EXPECT_EQ(WhyNone(Read(), {}, {"rabit/Beat", "rt/chatter_v1"}),
              "no program writes `rt/chatter` in domain 7; did you mean `rt/chatter_v1`?");
    EXPECT_EQ(WhyNone(Written(), {}, {"Pose"}), "no program reads `rt/chatter` in domain 7");
    EXPECT_EQ(WhyNone(Written(), {}, {"rt/chater"}),
              "no program reads `rt/chatter` in domain 7; did you mean `rt/chater`?");
}

TEST(ForeignMatch, AHintNamesNoTopicThatThisNodeUsesItself)
{
    bool isMismatch = false;
    ForeignMatch::Network network{7};
    network.Own = {"rt/chatter_v1"};
    EXPECT_EQ(ForeignMatch::WhyNone(Read(), ForeignMatch::FirstReaderQos(Read()), {},
                                    {"rt/chatter_v1", "rt/chatter_v2"}, network, isMismatch),
              "no program writes `rt/chatter` in domain 7; did you mean `rt/chatter_v2`?");
}

TEST(ForeignMatch, NamesAProgramThatFallsShortBesideOneThatMatches)
{
    const TopicQos ours = ForeignMatch::WriterQos(Written());
    const RemoteEndpoint asking = Reader(Reliability::Reliable, Durability::TransientLocal);
    const std::string why =
        "a program that reads `rt/chatter` asks for transient local, this node offers volatile";
    EXPECT_EQ(ForeignMatch::Shortfall(Written(), ours, {Reader(), asking}), why);
    EXPECT_EQ(ForeignMatch::Shortfall(Written(), ours, {asking, Reader()}), why);
    EXPECT_EQ(ForeignMatch::Shortfall(Written(), ours, {Reader(), Reader()}), "");
}

TEST(ForeignMatch, AProgramInAnotherPartitionDoesNotFallShort)
{
    RemoteEndpoint elsewhere = Reader(Reliability::Reliable, Durability::TransientLocal);
    elsewhere.Partitions = {"lab"};
    EXPECT_EQ(ForeignMatch::Shortfall(Written(), ForeignMatch::WriterQos(Written()), {Reader(), elsewhere}),
              "");
}

// Returns what is said of a reliable and a best-effort writer.
std::string ShortfallOfTwo(const ForeignRule &rule)
{
    const std::vector<RemoteEndpoint> two = {Writer(Reliability::Reliable), Writer(Reliability::BestEffort)};
    return ForeignMatch::Shortfall(
        rule, ForeignMatch::ReaderQos(rule, two, ForeignMatch::FirstReaderQos(rule)), two);
}

TEST(ForeignMatch, ABestEffortWriterThatTakesTheRepairFromAQueueIsNamed)
{
    ForeignRule rule = Read();
    rule.Each = ForeignRule::Delivery::Queue;
    EXPECT_EQ(
        ShortfallOfTwo(rule),
        "a program that writes `rt/chatter` is best effort, so this node reads the reliable ones without "
        "repair, too: samples may be lost; give the entry a `reliability`");
    rule.Reliability = Reliability::BestEffort;
    EXPECT_EQ(ShortfallOfTwo(rule), "") << "as the configuration says";
    EXPECT_EQ(ShortfallOfTwo(Read()), "") << "the newest sample is enough";
}

TEST(ForeignMatch, SaysOnWhichInterfacesProgramsAreReached)
{
    EXPECT_EQ(
        WhyNone(Read(), {}, {}, {"lo", "10.0.0.1"}),
        "no program writes `rt/chatter` in domain 7; a program that listens on other interfaces than `lo`, "
        "`10.0.0.1` cannot be reached");
    EXPECT_EQ(
        WhyNone(Written(), {}, {}, {"lo"}),
        "no program reads `rt/chatter` in domain 7; a program that listens on other interfaces than `lo` "
        "cannot be reached");
    EXPECT_EQ(WhyNone(Read(), {}, {"rt/chatter_v1"}, {"lo"}),
              "no program writes `rt/chatter` in domain 7; did you mean `rt/chatter_v1`?");
}

TEST(ForeignMatch, SaysThatOnlyNodesWriteIt)
{
    RemoteEndpoint node = Writer();
    node.Node = "uav2";
    EXPECT_EQ(WhyNone(Read(), {node}), "only nodes of Rabit, and no program, write `rt/chatter` in domain 7");
}

TEST(ForeignMatch, CountsThoseThatFit)
{
    RemoteEndpoint pattern = Writer();
    pattern.Partitions = {"*"};
    RemoteEndpoint node = Writer();
    node.Node = "uav2";
    const std::vector<RemoteEndpoint> endpoints = {Writer(), pattern, node, Reader()};
    EXPECT_EQ(
        ForeignMatch::Matching(Read(), ForeignMatch::ReaderQos(Read(), endpoints, {}), endpoints).size(), 2u);
    EXPECT_EQ(ForeignMatch::Matching(Written(), ForeignMatch::WriterQos(Written()), endpoints).size(), 1u);
}

}  // namespace
}  // namespace Rabit
