#include "recording/merge/Knowledge.h"

#include <gmock/gmock.h>

#include "SyntheticFleet.h"
#include "recording/merge/Merger.h"

namespace Rabit::Merge
{
namespace
{

using Time = SyntheticFleet::Time;

constexpr Time Ms = 1000000;
constexpr Time Minute = 60 * OneSecond;

// ground from minute 0 to 3; uav1 in two incarnations, with a pause of 20 s between them, minutes beside
// it.
class KnowledgeOfAFlight : public testing::Test
{
protected:
    static SyntheticFleet::Spec Node(const std::string &name, Time begin, Time end, Time wallAhead,
                                     std::uint64_t incarnation)
    {
        SyntheticFleet::Spec spec;
        spec.Name = name;
        spec.Begin = begin;
        spec.End = end;
        spec.WallAhead = wallAhead;
        spec.Incarnation = incarnation;
        return spec;
    }

    KnowledgeOfAFlight()
        : Fleet({Node("ground", 0, 3 * Minute, 0, 7), Node("uav1", 0, Minute, 5 * Minute, 1),
                 Node("uav1", Minute + 20 * OneSecond, 3 * Minute, -4 * Minute, 2)},
                [](std::size_t, std::size_t, Time, std::mt19937 &random)
                { return std::uniform_int_distribution<Time>(30 * Ms, 40 * Ms)(random); })
    {
        const OpenFile opener = Fleet.Opener();
        const Merge::Lives lives = ReadLives(opener, Fleet.Paths());
        const MergePlan plan = MakePlan(lives, {"ground"});
        Mcap::McapWriter writer(File, {"test", "rabit", true});
        Merger(opener, lives, plan, writer).Run([] { return false; });
        Contents = Mcap::ReadContents(File);
        Known.emplace(Contents);
    }

    const KnownStream *Find(const std::string &knower, unsigned life, const std::string &node)
    {
        for (const KnownStream &stream : Known->Streams)
        {
            const KnowerLife &one = Known->Lives[stream.Life];
            if (one.Node == knower && one.Number == life && stream.Node == node && stream.Message == "Pose")
            {
                return &stream;
            }
        }
        return nullptr;
    }
    std::optional<KnownValue> At(const std::string &knower, unsigned life, const std::string &node, Time at)
    {
        const KnownStream *stream = Find(knower, life, node);
        return stream == nullptr ? std::nullopt
                                 : ValueAt(File, Contents, *Known, *stream, Fleet.LogAt(0, at), Problems);
    }

    const SyntheticFleet Fleet;
    MemoryFile File;
    Mcap::Contents Contents;
    std::optional<Knowledge> Known;
    std::vector<std::string> Problems;
};

TEST_F(KnowledgeOfAFlight, ListsLivesAndWhatEachKnew)
{
    ASSERT_EQ(Known->Lives.size(), 3U);
    EXPECT_EQ(Known->Streams.size(),
              6U);  // each its own, each of the other; ground of two lives in one stream
    EXPECT_NE(Find("uav1", 2, "ground"), nullptr);
    EXPECT_EQ(Find("ground", 1, "uav1")->Type, "Test::Pose");
    EXPECT_TRUE(Known->WorstBound.has_value());
}

TEST_F(KnowledgeOfAFlight, TellsTheValueThatANodeHadAndHowOldItWas)
{
    const Time at = 30 * OneSecond;
    const auto value = At("ground", 1, "uav1", at);
    ASSERT_TRUE(value.has_value());
    const Time posted = SyntheticFleet::PostedOf(value->Sample);
    EXPECT_LT(posted, at - 30 * Ms);
    EXPECT_GT(posted, at - 250 * Ms);
    ASSERT_TRUE(value->UncertainBy.has_value());
    EXPECT_LT(*value->UncertainBy, 45 * Ms);
    EXPECT_NEAR(static_cast<double>(Fleet.LogAt(0, at) - value->PostedAt), static_cast<double>(at - posted),
                static_cast<double>(*value->UncertainBy));
    EXPECT_EQ(value->Incarnation, 1U);
    EXPECT_TRUE(Problems.empty());
}

TEST_F(KnowledgeOfAFlight, KnowsOfALifeThatHasEndedUntilTheNextIsHeard)
{
    const auto ended = At("ground", 1, "uav1", Minute + 15 * OneSecond);
    EXPECT_NEAR(static_cast<double>(SyntheticFleet::PostedOf(ended->Sample)), static_cast<double>(Minute),
                300.0 * Ms);
    EXPECT_EQ(ended->Incarnation, 1U);
    EXPECT_EQ(At("ground", 1, "uav1", Minute + 40 * OneSecond)->Incarnation, 2U);
}

TEST_F(KnowledgeOfAFlight, DoesNotTakeWhatAFormerLifeKnew)
{
    const Time born = Minute + 20 * OneSecond;
    EXPECT_FALSE(At("uav1", 2, "ground", born + 10 * Ms).has_value());
    EXPECT_TRUE(At("uav1", 2, "ground", born + 10 * OneSecond).has_value());
}

TEST_F(KnowledgeOfAFlight, TellsWhatANodeHadOfItself)
{
    const auto value = At("uav1", 1, "uav1", 30 * OneSecond);
    EXPECT_EQ(value->UncertainBy, 0);
    EXPECT_GT(SyntheticFleet::PostedOf(value->Sample), 30 * OneSecond - 220 * Ms);
}

TEST(Knowledge, IsThatOfOneNodeInARecordingThatWasNotMerged)
{
    SyntheticFleet::Spec uav1;
    uav1.Name = "uav1";
    uav1.End = Minute;
    SyntheticFleet::Spec uav2 = uav1;
    uav2.Name = "uav2";
    const SyntheticFleet fleet({uav1, uav2}, [](std::size_t, std::size_t, Time, std::mt19937 &random)
                               { return std::uniform_int_distribution<Time>(Ms, 2 * Ms)(random); });
    const auto source = fleet.Opener()("uav1_1_1.mcap");
    const Mcap::Contents contents = Mcap::ReadContents(*source);
    const Knowledge known(contents);
    ASSERT_EQ(known.Streams.size(), 2U);
    EXPECT_EQ(known.Lives[0].Node, "uav1");
    EXPECT_EQ(known.Streams[1].Node, "uav2");
    std::vector<std::string> problems;
    const auto value =
        ValueAt(*source, contents, known, known.Streams[1], FromFile(contents.Statistics.EndTime), problems);
    EXPECT_LT(*value->UncertainBy, 5 * Ms);
}

TEST(Knowledge, IsNothingInAFileOfOthers)
{
    MemoryFile file;
    Mcap::McapWriter writer(file, {"somebody", "", true});
    writer.AddMetadata({"rabit.recording", {{"node", "uav1"}, {"life", "-1"}, {"begin_ns", "x"}}});
    writer.Add({*writer.AddChannel(0, "topic", "json"), 0, 5, 5, Mcap::Bytes{1}});
    writer.Finish();
    const Knowledge known(Mcap::ReadContents(file));
    EXPECT_TRUE(known.Streams.empty());
}

}  // namespace
}  // namespace Rabit::Merge
