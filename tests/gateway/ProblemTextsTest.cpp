#include "report/ProblemTexts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "BeatSamples.h"
#include "report/FleetReport.h"
#include "wire/BeatExtensions.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ProblemTextsTest : public ::testing::Test
{
protected:
    // uav1 has those problems.
    void Hear(const ProblemCount &problems)
    {
        now += 500ms;
        HeardBeat heard;
        heard.Node = "uav1";
        heard.Incarnation = 5;
        heard.Beat = BeatAt(now);
        BeatExtensions::Say(heard.Beat, problems);
        heard.Arrival = now;
        peers.OnBeat(heard);
    }

    Gateway::NodeStatus Row()
    {
        Gateway::Fleet fleet;
        FleetReport::FillNodes(peers, now, fleet);
        texts.Fill(peers, fleet);
        return fleet.nodes[0];
    }

    // uav1 is there, and has not told whether it has problems.
    void Hear()
    {
        now += 500ms;
        HeardBeat heard;
        heard.Node = "uav1";
        heard.Incarnation = 5;
        heard.Beat = BeatAt(now);
        heard.Arrival = now;
        peers.OnBeat(heard);
    }

    const PeerTable::Peer &Uav() { return *peers.Find("uav1"); }

    std::chrono::nanoseconds now = 1s;
    PeerTable peers{"ground", 7};
    ProblemTexts texts;
};

TEST_F(ProblemTextsTest, WhatANodeReportsIsWhatItsRowTells)
{
    ProblemLog::Standing standing;
    standing.Digest = 4294967295;
    standing.Problems.emplace_back();
    standing.Problems[0].subject = "subscribe Pose";
    standing.Problems[0].reason = "nobody publishes it";
    Hear({.Count = 1, .Digest = standing.Digest});
    EXPECT_TRUE(texts.Lacks(Uav()));
    EXPECT_EQ(Row().problems, 1u);
    EXPECT_THAT(Row().problem_texts, IsEmpty());
    texts.Add(Uav(), ProblemTexts::ReportOf(standing));
    EXPECT_FALSE(texts.Lacks(Uav()));
    EXPECT_THAT(Row().problem_texts, ElementsAre("subscribe Pose: nobody publishes it"));
}

TEST_F(ProblemTextsTest, NothingIsLackingOfANodeThatSendsNoWords)
{
    Hear({.Count = 1, .Digest = 7});
    texts.Add(Uav(), ProblemTexts::ReportOf({.Problems = {}, .Digest = 7}));
    EXPECT_FALSE(texts.Lacks(Uav()));
    EXPECT_EQ(Row().problems, 1u);
    EXPECT_THAT(Row().problem_texts, IsEmpty());
}

TEST_F(ProblemTextsTest, OtherProblemsHaveOtherTexts)
{
    Hear({.Count = 1, .Digest = 7});
    texts.Add(Uav(), "7\nold\n");
    Hear({.Count = 1, .Digest = 8});
    EXPECT_TRUE(texts.Lacks(Uav()));
    EXPECT_THAT(Row().problem_texts, IsEmpty());
    Hear({});
    EXPECT_FALSE(texts.Lacks(Uav()));
    EXPECT_EQ(Row().problems, 0u);
}

TEST_F(ProblemTextsTest, TextsFromTheNetworkAreBoundedAndPrintable)
{
    Hear({.Count = 65535, .Digest = 7});
    std::string report = "7\n";
    for (int i = 0; i < 100; ++i)
    {
        report += "\x1b[2J" + std::string(1000, '\xff') + "\n";
    }
    texts.Add(Uav(), report);
    EXPECT_THAT(Row().problem_texts, SizeIs(ProblemTexts::MostTexts));
    EXPECT_THAT(Row().problem_texts, Each(::testing::StartsWith("?[2J?")));
    EXPECT_THAT(Row().problem_texts, Each(SizeIs(ProblemTexts::LongestText)));
    texts.Add(Uav(), "");
    texts.Add(Uav(), "no digest\n");
    EXPECT_THAT(Row().problem_texts, SizeIs(ProblemTexts::MostTexts));
}

TEST_F(ProblemTextsTest, ALostNodeHasNone)
{
    Hear({.Count = 1, .Digest = 7});
    texts.Add(Uav(), "7\nold\n");
    now += 1min;
    peers.Advance(now);
    EXPECT_FALSE(texts.Lacks(Uav()));
    EXPECT_EQ(Row().problems, 0u);
}

TEST_F(ProblemTextsTest, AToolAlsoAsksANodeThatHasNotToldOfProblems)
{
    Hear();
    EXPECT_FALSE(texts.Lacks(Uav()));
    ProblemTexts ofTool(true);
    EXPECT_TRUE(ofTool.Lacks(Uav()));
    Gateway::Fleet fleet;
    FleetReport::FillNodes(peers, now, fleet);
    ofTool.Fill(peers, fleet);
    EXPECT_FALSE(ofTool.AreTold("uav1"));
    ofTool.Add(Uav(), "7\nsubscribe Pose: nobody publishes it\n");
    ofTool.Fill(peers, fleet);
    EXPECT_TRUE(ofTool.AreTold("uav1"));
    EXPECT_EQ(fleet.nodes[0].problems, 1u);
    EXPECT_THAT(fleet.nodes[0].problem_texts, ElementsAre("subscribe Pose: nobody publishes it"));
}

TEST_F(ProblemTextsTest, AToolIsToldThatANodeHasNone)
{
    Hear();
    ProblemTexts ofTool(true);
    ofTool.Add(Uav(), ProblemTexts::ReportOf(ProblemLog("Gateway/Fleet").Lasted(now)));
    Gateway::Fleet fleet;
    FleetReport::FillNodes(peers, now, fleet);
    ofTool.Fill(peers, fleet);
    EXPECT_TRUE(ofTool.AreTold("uav1"));
    EXPECT_EQ(fleet.nodes[0].problems, 0u);
}

TEST_F(ProblemTextsTest, AToolAsksAgainAfterARestart)
{
    Hear();
    ProblemTexts ofTool(true);
    ofTool.Add(Uav(), "7\nold\n");
    EXPECT_FALSE(ofTool.Lacks(Uav()));
    HeardBeat heard;
    heard.Node = "uav1";
    heard.Incarnation = 6;
    heard.Beat = BeatAt(now + 500ms);
    heard.Arrival = now + 500ms;
    peers.OnBeat(heard);
    EXPECT_TRUE(ofTool.Lacks(Uav()));
}

TEST_F(ProblemTextsTest, ANodeThatRefusesWordsHasAProblemAllTheSame)
{
    Hear();
    ProblemTexts ofTool(true);
    ofTool.Add(Uav(), ProblemTexts::ReportOf({.Problems = {}, .Digest = 7}));
    Gateway::Fleet fleet;
    FleetReport::FillNodes(peers, now, fleet);
    ofTool.Fill(peers, fleet);
    EXPECT_EQ(fleet.nodes[0].problems, 1u);
}

}  // namespace
}  // namespace Rabit
