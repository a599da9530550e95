#include "wire/BeatExtensions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "BeatSamples.h"
#include "presence/PresenceInbox.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

using BeatExtensions::TypeQuestion;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BeatExtensions, ABeatIsOfAToolOnlyIfItSaysSo)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_FALSE(BeatExtensions::IsTool(beat));
    BeatExtensions::MarkTool(beat);
    EXPECT_TRUE(BeatExtensions::IsTool(beat));
}

TEST(BeatExtensions, ABeatIsOfAReplayOnlyIfItSaysSo)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::MarkTool(beat);
    EXPECT_FALSE(BeatExtensions::IsReplay(beat));
    BeatExtensions::MarkReplay(beat);
    EXPECT_TRUE(BeatExtensions::IsReplay(beat));
    EXPECT_TRUE(BeatExtensions::IsTool(beat));
}

TEST(BeatExtensions, WhatIsAskedForIsWhatIsUnderstood)
{
    const TypeQuestion first{.Node = 0xfedcba98, .Definition = 0x0123456789abcdef, .From = 70000};
    const TypeQuestion second{.Node = 1, .Definition = 2, .From = 0};
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Ask(beat, first);
    BeatExtensions::MarkTool(beat);
    BeatExtensions::Ask(beat, second);
    EXPECT_THAT(BeatExtensions::TypeQuestionsIn(beat), ElementsAre(first, second));
}

TEST(BeatExtensions, WhatABeatTellsOfAnAgreementIsWhatIsUnderstood)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_FALSE(BeatExtensions::AgreementIn(beat));
    const AgreementNews told{.Group = 0xfedcba98,
                             .Table = 0x0123456789abcdef,
                             .Renewal = std::vector<std::uint8_t>(8, 7),
                             .Answers = std::vector<std::uint8_t>(AgreementNews::MostAnswers, 9)};
    BeatExtensions::Say(beat, told);
    EXPECT_EQ(BeatExtensions::AgreementIn(beat), told);

    Gateway::Beat idle = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Say(idle, AgreementNews{.Group = 1});
    EXPECT_EQ(BeatExtensions::AgreementIn(idle), AgreementNews{.Group = 1});
}

TEST(BeatExtensions, OfTooManyAnswersOfAnAgreementTheFirstOnesAreRead)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Say(
        beat,
        AgreementNews{.Group = 1, .Answers = std::vector<std::uint8_t>(2 * AgreementNews::MostAnswers, 9)});
    ASSERT_TRUE(BeatExtensions::AgreementIn(beat));
    EXPECT_EQ(BeatExtensions::AgreementIn(beat)->Answers.size(), AgreementNews::MostAnswers);
}

TEST(BeatExtensions, OfFewNodesABeatTellsOfEachWhetherItIsHeardFirstHere)
{
    const std::vector<std::uint32_t> tags{3, 5};
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_EQ(BeatExtensions::IsFirstHeardHere(beat, 3), false);
    BeatExtensions::SayFirstHeard(beat, tags, 0);
    EXPECT_EQ(BeatExtensions::IsFirstHeardHere(beat, 3), true);
    EXPECT_EQ(BeatExtensions::IsFirstHeardHere(beat, 4), false);
    EXPECT_EQ(BeatExtensions::IsFirstHeardHere(beat, 6), false);
}

// Nodes 1, 3, 5, ... are heard here first.
TEST(BeatExtensions, OfManyNodesSomeBeatsTellOfEachAndNoneTellsWrong)
{
    std::vector<std::uint32_t> tags;
    for (std::uint32_t tag = 1; tags.size() < 100; tag += 2)
    {
        tags.push_back(tag);
    }
    std::vector<int> told(tags.back() + 2);
    std::size_t from = 0;
    for (int i = 0; i < 7; ++i)
    {
        Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
        from = BeatExtensions::SayFirstHeard(beat, tags, from);
        for (std::uint32_t tag = 0; tag < told.size(); ++tag)
        {
            const std::optional<bool> isFirst = BeatExtensions::IsFirstHeardHere(beat, tag);
            told[tag] += isFirst ? 1 : 0;
            EXPECT_EQ(isFirst.value_or(tag % 2 == 1), tag % 2 == 1) << tag;
        }
    }
    EXPECT_THAT(told, ::testing::Each(::testing::Gt(0)));
}

TEST(BeatExtensions, AQuestionOfAnotherSizeIsNone)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Ask(beat, TypeQuestion());
    NewsOf(beat).wants.back().states.pop_back();
    EXPECT_THAT(BeatExtensions::TypeQuestionsIn(beat), IsEmpty());
}

constexpr LinkStrain Full{
    .Node = 0xfedcba98, .What = LinkStrain::Kind::Filling, .Percent = 87, .Messages = 65535};
constexpr LinkStrain Slow{.Node = 7, .What = LinkStrain::Kind::HeldBack};

TEST(BeatExtensions, StrainsAreUnderstoodAsTheyWereSaid)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), IsEmpty());
    BeatExtensions::Say(beat, std::vector{Full, Slow});
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), ElementsAre(Full, Slow));
}

TEST(BeatExtensions, NoMoreStrainsAreSaidOrTakenThanABeatMayHave)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Say(beat, std::vector(9, Full));
    EXPECT_EQ(NewsOf(beat).wants.back().states.size(),
              BeatExtensions::MostStrains * BeatExtensions::StrainBytes);
    BeatExtensions::Say(beat, std::vector(9, Slow));
    EXPECT_EQ(BeatExtensions::StrainsIn(beat), std::vector(BeatExtensions::MostStrains, Full));
}

TEST(BeatExtensions, OfStrainsThatMakeNoSenseTheOthersAreTaken)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::Say(beat, std::vector{Full, Full, Slow});
    auto &bytes = NewsOf(beat).wants.back().states;
    bytes[4] = 0;     // no such kind
    bytes[13] = 200;  // more than all of it
    bytes.push_back(1);
    LinkStrain clamped = Full;
    clamped.Percent = 100;
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), ElementsAre(clamped, Slow));
    bytes[4] = 4;
    EXPECT_THAT(BeatExtensions::StrainsIn(beat), ElementsAre(clamped, Slow));
}

// Gateways that know no extensions judge beats by these rules, and look for their own tag in `wants`.
TEST(BeatExtensions, TheFirstGatewaysOfTheFormatTakeSuchABeat)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    BeatExtensions::MarkTool(beat);
    BeatExtensions::MarkReplay(beat);
    BeatExtensions::Ask(beat, TypeQuestion());
    BeatExtensions::Say(beat, std::vector(BeatExtensions::MostStrains, Full));
    const MessageType &type = GatewayTopics::TypeOf<Gateway::Beat>();
    std::vector<std::uint8_t> bytes(type.SerializedSize(beat));
    ASSERT_EQ(type.Serialize(beat, bytes), bytes.size());
    SampleInfo info;
    info.Node = "tool";
    info.SourceTime = 1;
    PresenceInbox inbox;
    EXPECT_TRUE(inbox.AddBeat(bytes, info, std::chrono::seconds(1)));
    EXPECT_EQ(inbox.Dropped(), 0u);
    EXPECT_EQ(beat.format, 0xbe03);
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
    {
        EXPECT_EQ(wanted.node, 0u);
    }
}

TEST(BeatExtensions, TheCountOfProblemsIsWhatIsUnderstood)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_EQ(BeatExtensions::ProblemsIn(beat), std::nullopt);
    BeatExtensions::MarkTool(beat);
    BeatExtensions::Say(beat, ProblemCount{.Count = 3, .Digest = 0xfedcba98});
    EXPECT_EQ(BeatExtensions::ProblemsIn(beat), (ProblemCount{.Count = 3, .Digest = 0xfedcba98}));
    NewsOf(beat).wants.back().states.pop_back();
    EXPECT_EQ(BeatExtensions::ProblemsIn(beat), std::nullopt);
}

TEST(BeatExtensions, TheSumOfAFleetIsWhatIsUnderstood)
{
    Gateway::Beat beat = BeatAt(std::chrono::seconds(1));
    EXPECT_EQ(BeatExtensions::FleetSumIn(beat), std::nullopt);
    BeatExtensions::MarkReplay(beat);
    BeatExtensions::SayFleetSum(beat, 0xfedcba98);
    EXPECT_EQ(BeatExtensions::FleetSumIn(beat), 0xfedcba98);
    NewsOf(beat).wants.back().states.pop_back();
    EXPECT_EQ(BeatExtensions::FleetSumIn(beat), std::nullopt);
}

}  // namespace
}  // namespace Rabit
