#include "presence/BeatContents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/AirCost.h>

#include <set>

#include "BeatSamples.h"
#include "air/AirBudget.h"
#include "names/NodeTag.h"
#include "presence/Whereabouts.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Ns = std::chrono::nanoseconds;

std::size_t BodyOf(const Gateway::Beat &beat)
{
    return GatewayTopics::TypeOf<Gateway::Beat>().SerializedSize(beat) - AirCost::Encapsulation;
}

TEST(Beat, AnEmptyOneTakesLessThan110BytesOnTheAir)
{
    Gateway::Beat beat;
    EXPECT_EQ(BodyOf(beat), BeatFormat::WithNews);
    DropEmptyNews(beat);
    EXPECT_EQ(BodyOf(beat), BeatFormat::Empty);
    EXPECT_LT(AirCost(1400).Of(BeatFormat::Empty), 110u);
}

TEST(Beat, TheLargestFitsTheSmallestDatagramThatSettingsAllow)
{
    EXPECT_LE(AirCost(TransportSettings::SmallestDatagram).Of(BeatFormat::Largest),
              TransportSettings::SmallestDatagram + AirCost::IpAndUdp);
}

TEST(Beat, SaysWhereItsNodeRunsInTheSameNumberOfBytesWhateverTheHostIsCalled)
{
    EXPECT_EQ(Whereabouts::Part().bytes.size(), Whereabouts::Size);
    EXPECT_LE(Whereabouts::OfThisProcess().size(), Whereabouts::Size);
}

class BeatContentsTest : public ::testing::Test
{
protected:
    void Begin(std::size_t offers, std::size_t states)
    {
        contents.Begin(std::vector<std::uint8_t>(offers, 7), states);
        for (std::size_t i = 0; i < states; ++i)
        {
            contents.SetStateVersion(i, static_cast<std::uint32_t>(1000 + i));
        }
    }

    // Begins, and says everything that the node announces at its beginning.
    void BeginLongAgo(std::size_t offers, std::size_t states)
    {
        Begin(offers, states);
        while (contents.Answer().Due())
        {
            contents.Answer().Said(contents.Answer().Left(), 0s);
        }
    }

    void Hear(const std::string &node, Ns at, std::uint32_t offers = 0)
    {
        HeardBeat heard;
        heard.Node = node;
        heard.Incarnation = 5;
        heard.Beat = BeatAt(at);
        heard.Beat.offers = offers;
        heard.Arrival = at;
        peers.OnBeat(heard);
    }

    void HearTool(const std::string &tool, Ns at)
    {
        HeardBeat heard;
        heard.Node = tool;
        heard.Incarnation = 5;
        heard.Beat = BeatAt(at);
        BeatExtensions::MarkTool(heard.Beat);
        heard.Arrival = at;
        peers.OnBeat(heard);
    }

    Gateway::Beat Next(Ns now, std::size_t most = BeatFormat::Largest)
    {
        const std::size_t said = contents.Size(now);
        Gateway::Beat beat;
        contents.Fill(beat, now, most);
        EXPECT_LE(BodyOf(beat), std::max(most, BeatFormat::Empty));
        EXPECT_LE(BodyOf(beat), said);
        return beat;
    }

    PeerTable peers{"ground", 7};
    BeatContents contents{peers, [] { return 0; }};
};

TEST_F(BeatContentsTest, WhereTheNodeRunsIsSaidNowAndThenWhileAnotherHasItsName)
{
    BeginLongAgo(100, 0);
    for (int beat = 0; beat < 3; ++beat)
    {
        HeardBeat twin;
        twin.Node = "ground";
        twin.Incarnation = 8;
        twin.Arrival = 1s + beat * 100ms;
        peers.OnBeat(twin);
    }
    EXPECT_EQ(Whereabouts::In(Next(1s)), Whereabouts::OfThisProcess());
    EXPECT_EQ(BodyOf(Next(1500ms)), BeatFormat::Empty);
    EXPECT_EQ(Whereabouts::In(Next(4s)), Whereabouts::OfThisProcess());
    EXPECT_THAT(NewsOf(Next(8s, 60)).parts, IsEmpty()) << "no room";
    peers.Advance(20s);
    EXPECT_EQ(BodyOf(Next(20s)), BeatFormat::Empty);
}

TEST_F(BeatContentsTest, WhoHasNothingToSayHasAnEmptyBeat)
{
    BeginLongAgo(100, 0);
    EXPECT_EQ(contents.Size(10s), BeatFormat::Empty);
    EXPECT_EQ(BodyOf(Next(10s)), BeatFormat::Empty);
}

TEST_F(BeatContentsTest, AReplaySaysInEachBeatThatItIsOne)
{
    contents.BeReplay();
    Begin(0, 0);
    for (int i = 0; i < 3; ++i)
    {
        const Ns now = std::chrono::minutes(i + 1);
        const std::size_t size = contents.Size(now);
        Gateway::Beat beat;
        contents.Fill(beat, now, size);
        EXPECT_TRUE(BeatExtensions::IsReplay(beat));
        EXPECT_LE(BodyOf(beat), size);
    }
}

TEST_F(BeatContentsTest, AnAgreementIsSaidInEachBeatAndIsToldItsRoom)
{
    AgreementNews news{.Group = 1, .Table = 2};
    std::size_t told = 0;
    contents.SetAgreement(
        {.Size = [&news] { return BeatFormat::Agreement(news.Renewal.size(), news.Answers.size()); },
         .Take =
             [&](std::size_t room)
         {
             told = room;
             AgreementNews taken = news;
             if (BeatFormat::Agreement(news.Renewal.size(), news.Answers.size()) > room)
             {
                 taken.Answers.clear();
             }
             return taken;
         }});
    BeginLongAgo(100, 0);
    EXPECT_EQ(contents.Size(10s), BeatFormat::WithNews + BeatFormat::Agreement(0, 0));
    EXPECT_EQ(contents.LeastSize(10s), contents.Size(10s));
    EXPECT_EQ(BeatExtensions::AgreementIn(Next(10s)), news);

    news.Renewal.assign(8, 3);
    news.Answers.assign(2 * 13, 4);
    EXPECT_EQ(contents.Size(12s), BeatFormat::WithNews + BeatFormat::Agreement(8, 26));
    EXPECT_EQ(BeatExtensions::AgreementIn(Next(12s, contents.Size(12s))), news);
    EXPECT_EQ(told, BeatFormat::Agreement(8, 26));
    const Gateway::Beat next = Next(13s, BeatFormat::WithNews + BeatFormat::Agreement(8, 0));
    EXPECT_EQ(BeatExtensions::AgreementIn(next)->Renewal, news.Renewal);
    EXPECT_THAT(BeatExtensions::AgreementIn(next)->Answers, IsEmpty());
    told = 0;
    const std::size_t less = BeatFormat::WithNews + BeatFormat::Agreement(0, 0) - 1;
    EXPECT_FALSE(BeatExtensions::AgreementIn(Next(14s, less))) << "Next looks at the size";
    EXPECT_EQ(told, 0u) << "nothing was taken that is not said";
}

TEST_F(BeatContentsTest, StrainsAreSaidAsLongAsThereAreAnyAndThenCostNothing)
{
    BeginLongAgo(100, 0);
    const std::vector<LinkStrain> strains(3, LinkStrain{.Node = 7, .What = LinkStrain::Kind::InDoubt});
    contents.SetStrains(strains);
    for (int i = 1; i <= 3; ++i)
    {
        EXPECT_EQ(BeatExtensions::StrainsIn(Next(std::chrono::seconds(i))), strains);
    }
    contents.SetStrains({});
    EXPECT_EQ(BodyOf(Next(4s)), BeatFormat::Empty);
}

TEST_F(BeatContentsTest, ProblemsAreSaidThreeTimesThenSeldomAndTheirEndThreeTimes)
{
    BeginLongAgo(100, 0);
    const ProblemCount problems{.Count = 2, .Digest = 7};
    contents.SetProblems(problems);
    for (int i = 1; i <= 3; ++i)
    {
        const Ns now = std::chrono::seconds(i);
        const std::size_t size = contents.Size(now);
        const Gateway::Beat beat = Next(now, size);
        EXPECT_EQ(BeatExtensions::ProblemsIn(beat), problems);
        EXPECT_LE(BodyOf(beat), size);
    }
    contents.SetProblems(problems);
    EXPECT_EQ(BodyOf(Next(4s)), BeatFormat::Empty);
    EXPECT_EQ(BeatExtensions::ProblemsIn(Next(3s + BeatContents::ProblemPeriod)), problems);
    EXPECT_EQ(BodyOf(Next(14s)), BeatFormat::Empty);
    contents.RepeatProblems();
    EXPECT_EQ(BeatExtensions::ProblemsIn(Next(15s)), problems);
    contents.SetProblems({});
    for (int i = 16; i <= 18; ++i)
    {
        EXPECT_EQ(BeatExtensions::ProblemsIn(Next(std::chrono::seconds(i))), ProblemCount());
    }
    contents.RepeatProblems();
    EXPECT_EQ(BodyOf(Next(60s)), BeatFormat::Empty);
}

TEST_F(BeatContentsTest, ProblemsAndStrainsAreSaidInBeatsThatAnAnnouncementFills)
{
    Begin(4000, 10);
    const ProblemCount problems{.Count = 2, .Digest = 7};
    contents.SetProblems(problems);
    contents.SetStrains(std::vector<LinkStrain>(BeatExtensions::MostStrains));
    for (Ns now = 1s; now < 1150ms; now += 50ms)
    {
        const Gateway::Beat beat = Next(now);
        ASSERT_THAT(NewsOf(beat).parts, SizeIs(1));
        EXPECT_EQ(BeatExtensions::ProblemsIn(beat), problems);
        EXPECT_THAT(BeatExtensions::StrainsIn(beat), SizeIs(BeatExtensions::MostStrains));
    }
}

TEST_F(BeatContentsTest, ProblemsAreSaidInTheSmallestBeatOfABudgetBeforeAnythingElse)
{
    Begin(4000, 10);
    for (int i = 0; i < 20; ++i)
    {
        Hear("uav" + std::to_string(i), 1s, 99);
    }
    const ProblemCount problems{.Count = 2, .Digest = 7};
    contents.SetProblems(problems);
    const Gateway::Beat beat = Next(2s, AirCost(1400).BodyWithin(AirBudget::SmallestDatagram, false));
    EXPECT_EQ(BeatExtensions::ProblemsIn(beat), problems);
}

TEST_F(BeatContentsTest, TheWorstStrainsGoBeforeStatesAndTheOthersWaitForRoom)
{
    BeginLongAgo(100, 3);
    contents.SetStrains(std::vector<LinkStrain>(9));
    const std::size_t strains = BeatFormat::Wanted(BeatExtensions::MostStrains * BeatExtensions::StrainBytes);
    const Gateway::Beat first = Next(1s, BeatFormat::WithNews + strains - 1);
    EXPECT_THAT(BeatExtensions::StrainsIn(first), SizeIs(BeatExtensions::MostStrains - 1));
    EXPECT_THAT(NewsOf(first).states, SizeIs(1));
    const Gateway::Beat with = Next(2s, BeatFormat::WithNews + strains + BeatFormat::State);
    EXPECT_THAT(BeatExtensions::StrainsIn(with), SizeIs(BeatExtensions::MostStrains));
    EXPECT_THAT(NewsOf(with).states, SizeIs(1));
}

// Receivers take a beat without strains as their end.
TEST_F(BeatContentsTest, StrainsAreSaidInASmallBeatThatQuestionsCouldFill)
{
    BeginLongAgo(100, 0);
    for (int i = 0; i < 20; ++i)
    {
        Hear("uav" + std::to_string(i), 1s, 99);
    }
    contents.SetStrains(std::vector<LinkStrain>(2));
    const Gateway::Beat beat = Next(2s, BeatFormat::WithNews + BeatFormat::MostWants * BeatFormat::Wanted(0));
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), SizeIs(2));
    EXPECT_GT(NewsOf(beat).wants.size(), 1u) << "questions take what is left";
}

TEST_F(BeatContentsTest, TheLeastBeatHasAPartOfTheAnnouncementThatIsDueHoweverMuchElseThereIsToSay)
{
    Begin(4000, 10);
    for (int i = 0; i < 20; ++i)
    {
        Hear("uav" + std::to_string(i), 1s, 99);
    }
    contents.SetProblems({.Count = 2, .Digest = 7});
    contents.SetStrains(std::vector<LinkStrain>(3));
    const Gateway::Beat beat = Next(2s, contents.LeastSize(2s));
    ASSERT_THAT(NewsOf(beat).parts, SizeIs(1));
    EXPECT_THAT(NewsOf(beat).parts[0].bytes, SizeIs(64));
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), SizeIs(1));
    EXPECT_TRUE(BeatExtensions::ProblemsIn(beat).has_value());
}

TEST_F(BeatContentsTest, TheLeastBeatIsEmptyWhileNoPartOfTheAnnouncementIsDue)
{
    BeginLongAgo(100, 10);
    EXPECT_EQ(contents.LeastSize(2s), BeatFormat::Empty);
}

TEST_F(BeatContentsTest, TheFirstBeatOfALifeCarriesTheAnnouncement)
{
    Begin(100, 0);
    const Gateway::Beat beat = Next(1s);
    ASSERT_THAT(NewsOf(beat).parts, SizeIs(1));
    EXPECT_THAT(NewsOf(beat).parts[0].bytes, SizeIs(100));
    EXPECT_THAT(NewsOf(Next(2s)).parts, IsEmpty());
}

TEST_F(BeatContentsTest, AnAnnouncementThatDoesNotFitGoesInParts)
{
    Begin(2000, 0);
    OffersCollector collector;
    auto outcome = OffersCollector::Outcome::Incomplete;
    int beats = 0;
    for (Ns now = 1s; outcome == OffersCollector::Outcome::Incomplete && beats < 10; now += 50ms, ++beats)
    {
        const Gateway::Beat beat = Next(now);
        ASSERT_THAT(NewsOf(beat).parts, SizeIs(1));
        outcome = collector.Add(contents.OffersDigest(), NewsOf(beat).parts[0]);
    }
    EXPECT_EQ(outcome, OffersCollector::Outcome::Complete);
    EXPECT_EQ(beats, 3);
}

TEST_F(BeatContentsTest, TheLargestAnnouncementGetsThroughBeatsOfAnySize)
{
    Begin(Announcements::LargestEncoded, 512);
    OffersCollector collector;
    auto outcome = OffersCollector::Outcome::Incomplete;
    Ns now = 1s;
    for (int i = 0; outcome == OffersCollector::Outcome::Incomplete && i < 1000; ++i, now += 50ms)
    {
        const Gateway::Beat beat = Next(now, 20 + 37 * static_cast<std::size_t>(i % 20));
        if (!NewsOf(beat).parts.empty())
        {
            outcome = collector.Add(contents.OffersDigest(), NewsOf(beat).parts[0]);
        }
    }
    EXPECT_EQ(outcome, OffersCollector::Outcome::Complete);
}

TEST_F(BeatContentsTest, StatesAreToldInEachBeat)
{
    BeginLongAgo(100, 3);
    EXPECT_THAT(NewsOf(Next(1s)).states, ElementsAre(1000, 1001, 1002));
    contents.SetStateVersion(1, 5);
    EXPECT_THAT(NewsOf(Next(2s)).states, ElementsAre(1000, 5, 1002));
}

TEST_F(BeatContentsTest, ManyStatesAreToldInTurns)
{
    BeginLongAgo(100, 150);
    std::vector<std::uint32_t> told;
    for (Ns now = 1s; now < 4s; now += 1s)
    {
        const Gateway::Beat beat = Next(now);
        EXPECT_EQ(NewsOf(beat).first_state, told.size());
        EXPECT_LE(NewsOf(beat).states.size(), BeatFormat::MostStates);
        told.insert(told.end(), NewsOf(beat).states.begin(), NewsOf(beat).states.end());
    }
    ASSERT_EQ(told.size(), 150u);
    EXPECT_EQ(told[149], 1149u);
    EXPECT_EQ(NewsOf(Next(5s)).first_state, 0);
}

TEST_F(BeatContentsTest, WhatABeatHasNoRoomForFollowsInTheNextOnes)
{
    BeginLongAgo(100, 10);
    EXPECT_THAT(NewsOf(Next(1s, BeatFormat::Empty)).states, IsEmpty());
    EXPECT_THAT(NewsOf(Next(2s, BeatFormat::WithNews + 24)).states, SizeIs(6));
    const Gateway::Beat beat = Next(3s, BeatFormat::WithNews + 24);
    EXPECT_EQ(NewsOf(beat).first_state, 6);
    EXPECT_THAT(NewsOf(beat).states, SizeIs(4));
}

TEST_F(BeatContentsTest, WhoLacksSomethingAsksForItByItsTag)
{
    BeginLongAgo(100, 0);
    Hear("uav1", 1s, 99);
    EXPECT_EQ(contents.QuestionDue(), Ns(1s + MissingOffers::AskAfter));
    contents.Questions().Set("uav1", {false, true}, true, 2s);
    const Gateway::Beat beat = Next(2s);
    ASSERT_THAT(NewsOf(beat).wants, SizeIs(1));
    EXPECT_EQ(NewsOf(beat).wants[0].node, NodeTagOf("uav1", 5));
    EXPECT_EQ(NewsOf(beat).wants[0].offers, 0);
    EXPECT_THAT(NewsOf(beat).wants[0].states, ElementsAre(2));
}

TEST_F(BeatContentsTest, WhoLacksAStateAloneDoesNotAskForTheAnnouncement)
{
    BeginLongAgo(100, 0);
    Hear("uav1", 1s, 99);
    peers.Missing().LetGo("uav1");
    contents.Questions().Set("uav1", {true}, true, 2s);
    EXPECT_EQ(contents.QuestionDue(), Ns(2s));
    EXPECT_EQ(NewsOf(Next(2s)).wants.at(0).offers, BeatFormat::NotLacking);
}

// Without a report the node would take its datagrams for punctual.
TEST_F(BeatContentsTest, DelaysAreReportedBeforeAnythingIsAsked)
{
    BeginLongAgo(100, 0);
    Hear("uav1", 1s, 99);
    contents.Delays().Note(NodeTagOf("uav1", 5), 500ms, 1s);
    const std::size_t room = BeatFormat::WithNews + BeatFormat::Wanted(0);
    const Gateway::Beat first = Next(2s, room);
    EXPECT_THAT(NewsOf(first).delays, SizeIs(1));
    EXPECT_THAT(NewsOf(first).wants, IsEmpty());
    EXPECT_THAT(NewsOf(Next(3s, room)).wants, SizeIs(1));
}

TEST_F(BeatContentsTest, NothingIsAskedOfWhoIsLostOrUnknown)
{
    BeginLongAgo(100, 0);
    Hear("uav1", 1s, 99);
    peers.Advance(60s);
    contents.Questions().Set("uav1", {true}, true, 60s);
    contents.Questions().Set("uav2", {true}, true, 60s);
    EXPECT_THAT(NewsOf(Next(60s)).wants, IsEmpty());
}

TEST_F(BeatContentsTest, ACrowdIsAskedEchoedAndToldInTurnsAndTheBeatStaysSmall)
{
    BeginLongAgo(5000, 512);
    for (int i = 0; i < 100; ++i)
    {
        const std::string node = std::string("n").append(std::to_string(i));
        Hear(node, 1s, 99);
        contents.Questions().Set(node, std::vector<bool>(512, true), true, 1s);
        contents.Delays().Note(NodeTagOf(node, 5), 500ms, 1s);
    }
    contents.Answer().Asked(0, 0, 1s);
    std::set<std::uint32_t> asked;
    std::set<std::uint32_t> echoed;
    std::set<std::uint32_t> told;
    for (int i = 0; i < 60; ++i)
    {
        const Gateway::Beat beat = Next(1500ms + i * 50ms);
        for (const auto &wanted : NewsOf(beat).wants)
        {
            asked.insert(wanted.node);
        }
        for (const auto &echo : NewsOf(beat).echoes)
        {
            echoed.insert(echo.node);
        }
        for (const auto &report : NewsOf(beat).delays)
        {
            told.insert(report.node);
        }
    }
    EXPECT_EQ(asked.size(), 100u);
    EXPECT_EQ(echoed.size(), 100u);
    EXPECT_EQ(told.size(), 100u);
}

TEST_F(BeatContentsTest, TheSumOfTheFleetIsSaidThreeTimesToEachToolThatComes)
{
    BeginLongAgo(100, 0);
    Hear("uav1", 1s);
    contents.LookAtFleet();
    EXPECT_EQ(BeatExtensions::FleetSumIn(Next(2s)), std::nullopt) << "no tool is there";
    for (const std::string tool : {"tool1", "tool2"})
    {
        HearTool(tool, 2s);
        for (int i = 0; i < 3; ++i)
        {
            contents.LookAtFleet();
            EXPECT_EQ(BeatExtensions::FleetSumIn(Next(2s)), peers.FleetSum());
        }
        contents.LookAtFleet();
        EXPECT_EQ(BeatExtensions::FleetSumIn(Next(2s)), std::nullopt);
    }
}

TEST_F(BeatContentsTest, TheSumOfTheFleetIsSaidAgainIfItChangesWhileAToolIsThere)
{
    BeginLongAgo(100, 0);
    HearTool("tool", 1s);
    for (int i = 0; i < 3; ++i)
    {
        contents.LookAtFleet();
        Next(1s);
    }
    Hear("uav1", 2s);
    contents.LookAtFleet();
    EXPECT_EQ(BeatExtensions::FleetSumIn(Next(2s)), peers.FleetSum());
}

TEST_F(BeatContentsTest, AToolDoesNotSayTheSumOfTheFleet)
{
    contents.BeTool();
    BeginLongAgo(100, 0);
    HearTool("tool", 1s);
    contents.LookAtFleet();
    EXPECT_EQ(BeatExtensions::FleetSumIn(Next(1s)), std::nullopt);
}

}  // namespace
}  // namespace Rabit
