#include <gtest/gtest.h>

#include <vector>

#include "paths/PathChoice.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Gateway::NodeState;

constexpr std::size_t Mesh = 0;
constexpr std::size_t Modem = 1;

class PathChoiceTest : public ::testing::Test
{
protected:
    void Hear(std::size_t path, NodeState state, PathChoice::Duration now)
    {
        choice.Heard("uav1", path, state, false, now);
    }
    std::size_t ChosenAt(PathChoice::Duration now)
    {
        changed = choice.TakeChanged(now);
        return choice.Of("uav1");
    }
    // A failure of the mesh at that time, and its return a second later.
    void FailMesh(PathChoice::Duration now)
    {
        Hear(Mesh, NodeState::STALE, now);
        Hear(Mesh, NodeState::UP, now + 1s);
    }

    PathChoice choice{2};
    std::vector<std::string> changed;
};

TEST_F(PathChoiceTest, ANodeIsReachedByTheFirstPathOnWhichItIsUp)
{
    Hear(Modem, NodeState::UP, 0s);
    EXPECT_EQ(ChosenAt(0s), Modem);
    Hear(Mesh, NodeState::UP, 1s);
    EXPECT_EQ(ChosenAt(1s), Mesh);
    EXPECT_EQ(changed, std::vector<std::string>{"uav1"});
}

TEST_F(PathChoiceTest, ADeadPathIsLeft)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    Hear(Mesh, NodeState::STALE, 5s);
    EXPECT_EQ(ChosenAt(5s), Modem);
}

TEST_F(PathChoiceTest, APathThatReturnsRestsForASecond)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    FailMesh(5s);
    EXPECT_EQ(ChosenAt(6900ms), Modem);
    ASSERT_TRUE(choice.Due());
    EXPECT_EQ(*choice.Due(), 7s);
    EXPECT_EQ(ChosenAt(7s), Mesh);
}

TEST_F(PathChoiceTest, APathThatComesAndGoesRestsForLongerAndLonger)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    FailMesh(5s);
    FailMesh(7s);
    FailMesh(9s);
    EXPECT_EQ(ChosenAt(13900ms), Modem);
    EXPECT_EQ(ChosenAt(14s), Mesh);
}

TEST_F(PathChoiceTest, APathThatWasSoundForTenSecondsRestsForASecondAgain)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    FailMesh(5s);
    FailMesh(7s);
    FailMesh(21s);
    EXPECT_EQ(ChosenAt(23s), Mesh);
}

TEST_F(PathChoiceTest, IfAllPathsAreDeadTheLastOneStays)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    Hear(Mesh, NodeState::LOST, 5s);
    Hear(Modem, NodeState::LOST, 6s);
    EXPECT_EQ(ChosenAt(6s), Modem);
}

TEST_F(PathChoiceTest, APathThatRestsIsBetterThanNone)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    FailMesh(5s);
    Hear(Modem, NodeState::LOST, 6s);
    EXPECT_EQ(ChosenAt(6s), Mesh);
}

TEST_F(PathChoiceTest, WhileAnAnswerIsMissingFramesGoByBothPaths)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Unanswered("uav1", 5s);
    EXPECT_EQ(ChosenAt(5s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 5s), Modem);
}

TEST_F(PathChoiceTest, ADoubtEndsSomeTimeAfterItsLastSignThoughNoFrameComes)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Unanswered("uav1", 5s);
    choice.Unanswered("uav1", 6s);
    EXPECT_EQ(choice.Second("uav1", 6s + PathChoice::Both - 1ms), Modem);
    EXPECT_EQ(choice.Second("uav1", 6s + PathChoice::Both), std::nullopt);
    choice.CameBy("uav1", Modem, 20s);
    EXPECT_EQ(choice.Second("uav1", 20s + PathChoice::Both - 1ms), Modem);
    EXPECT_EQ(choice.Second("uav1", 20s + PathChoice::Both), std::nullopt);
}

TEST_F(PathChoiceTest, ADeadNodeHasNoSecondPath)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Unanswered("uav1", 5s);
    Hear(Modem, NodeState::LOST, 6s);
    EXPECT_EQ(choice.Second("uav1", 6s), std::nullopt);
    Hear(Mesh, NodeState::LOST, 6s);
    EXPECT_FALSE(choice.Unanswered("uav1", 6s));
    choice.CameBy("uav1", Modem, 6s);
    EXPECT_EQ(choice.Second("uav1", 6s), std::nullopt);
    EXPECT_FALSE(choice.IsSecondOfAny(Modem, 6s));
}

TEST(PathChoiceOfThreePaths, TakesAnotherSecondPathIfThatOneDies)
{
    PathChoice choice{3};
    for (const std::size_t path : {0U, 1U, 2U})
    {
        choice.Heard("uav1", path, NodeState::UP, false, 0s);
    }
    choice.Unanswered("uav1", 5s);
    EXPECT_EQ(choice.Second("uav1", 5s), 1U);
    choice.Heard("uav1", 1, NodeState::LOST, false, 5500ms);
    choice.Late("uav1", 0, true);
    EXPECT_EQ(choice.Second("uav1", 5500ms), 2U);
}

TEST_F(PathChoiceTest, AMissingAnswerIsNewsThoughFramesGoByBothPathsAlready)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Late("uav1", Mesh, true);
    EXPECT_TRUE(choice.Unanswered("uav1", 5s));
    EXPECT_FALSE(choice.Unanswered("uav1", 5100ms)) << "still the same";
    EXPECT_TRUE(choice.Unanswered("uav1", 5100ms + PathChoice::Both));
}

TEST_F(PathChoiceTest, APathThatFailedHasCompanyUntilItIsSoundAgain)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    FailMesh(5s);
    EXPECT_EQ(ChosenAt(7s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 7s), Modem);
    EXPECT_TRUE(choice.IsSecondOfAny(Modem, 7s));
    EXPECT_EQ(choice.Second("uav1", 7s + PathChoice::Sound), Modem);
    EXPECT_EQ(choice.Second("uav1", 7s + PathChoice::Sound + 1ms), std::nullopt);
    EXPECT_FALSE(choice.IsSecondOfAny(Modem, 7s + PathChoice::Sound + 1ms));
}

TEST_F(PathChoiceTest, IfAllPathsHaveFailedNoneIsCompanyForAnother)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    Hear(Modem, NodeState::LOST, 5s);
    FailMesh(5s);
    Hear(Modem, NodeState::UP, 6s);
    EXPECT_EQ(ChosenAt(8s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 8s), std::nullopt);
}

TEST_F(PathChoiceTest, WhileABeatIsLateTheOtherPathIsUsedAsWell)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Late("uav1", Mesh, true);
    EXPECT_EQ(ChosenAt(5s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 5s), Modem);
    choice.Late("uav1", Mesh, false);
    EXPECT_EQ(choice.Second("uav1", 5s), std::nullopt);
}

TEST(PathChoiceOfABigAndASmallPath, LeavesTheBigOneForSomeSecondsAtMost)
{
    PathChoice choice(2, {1e6, 1500});
    choice.Heard("uav1", Mesh, NodeState::UP, false, 0s);
    choice.Heard("uav1", Modem, NodeState::UP, false, 0s);
    for (const PathChoice::Duration now : {5s, 7s, 9s, 11s, 13s})
    {
        choice.Heard("uav1", Mesh, NodeState::STALE, false, now);
        choice.Heard("uav1", Mesh, NodeState::UP, false, now + 1s);
    }
    choice.TakeChanged(14s + PathChoice::ShortRest - 1ms);
    EXPECT_EQ(choice.Of("uav1"), Modem);
    choice.TakeChanged(14s + PathChoice::ShortRest);
    EXPECT_EQ(choice.Of("uav1"), Mesh);
}

// Beats of a path that come and do not come, in turns, from that time on. Returns when the last
// loss was noticed.
PathChoice::Duration Lose(PathChoice &choice, int missed, int came, int times, PathChoice::Duration now,
                          std::size_t path = Mesh)
{
    BeatCount beats;
    std::uint64_t number = 1;
    PathChoice::Duration noticed = now;
    beats.Add(number);
    for (int i = 0; i < times; ++i)
    {
        number += static_cast<std::uint64_t>(missed);
        for (int j = 0; j < came; ++j)
        {
            beats.Add(++number);
            now += 500ms;
            if (j == 0)
            {
                choice.Missed("uav1", path, beats, now);
                noticed = now;
            }
        }
    }
    return noticed;
}

TEST_F(PathChoiceTest, APathByWhichManyBeatsDoNotComeIsLeftThoughItStaysUp)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    const PathChoice::Duration now = Lose(choice, 2, 2, 3, 5s);
    EXPECT_EQ(ChosenAt(now), Modem);
    EXPECT_EQ(choice.FirstHeardOn(Modem), std::vector<std::string>{"uav1"});
    EXPECT_EQ(ChosenAt(now + 1s), Mesh);
    EXPECT_TRUE(choice.TakeFirstHeardChanged());
    EXPECT_TRUE(choice.FirstHeardOn(Modem).empty());
}

TEST_F(PathChoiceTest, BeatsThatAreMissedDuringARestAreNoSecondFailure)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    const PathChoice::Duration now = Lose(choice, 2, 2, 3, 5s);
    Lose(choice, 2, 1, 1, now);
    EXPECT_EQ(ChosenAt(now + 900ms), Modem);
    EXPECT_EQ(ChosenAt(now + 1s), Mesh);
}

TEST_F(PathChoiceTest, ALossyPathIsKeptIfTheOtherLosesAsMuch)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    Lose(choice, 2, 2, 3, 5s, Modem);
    EXPECT_EQ(ChosenAt(Lose(choice, 2, 2, 3, 20s)), Mesh);
}

TEST_F(PathChoiceTest, ALossyPathIsKeptIfTheOtherHasASmallerBudget)
{
    PathChoice small(2, {1e6, 1500});
    small.Heard("uav1", Mesh, NodeState::UP, false, 0s);
    small.Heard("uav1", Modem, NodeState::UP, false, 0s);
    small.TakeChanged(Lose(small, 2, 2, 3, 5s));
    EXPECT_EQ(small.Of("uav1"), Mesh);
}

TEST_F(PathChoiceTest, APathThatLosesABeatInTenIsKept)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    EXPECT_EQ(ChosenAt(Lose(choice, 1, 9, 100, 5s)), Mesh);
}

TEST_F(PathChoiceTest, BeatsThatWereMissedWhileThePathWasDeadAreNoSecondFailure)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    Hear(Mesh, NodeState::STALE, 5s);
    Lose(choice, 20, 1, 1, 5500ms);
    Hear(Mesh, NodeState::UP, 6s);
    EXPECT_EQ(ChosenAt(7s), Mesh);
}

TEST_F(PathChoiceTest, WhileBothEndsLeaveAPathEachTellsTheOtherWhenItHearsWellAgain)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    const PathChoice::Duration now = Lose(choice, 2, 2, 3, 5s);
    choice.Heard("uav1", Modem, NodeState::UP, true, now);
    EXPECT_TRUE(choice.TakeFirstHeardChanged());
    EXPECT_EQ(ChosenAt(now + 1s), Modem);
    EXPECT_TRUE(choice.TakeFirstHeardChanged());
    EXPECT_TRUE(choice.FirstHeardOn(Modem).empty());
}

TEST_F(PathChoiceTest, ANodeThatHearsThisOneByALaterPathAloneIsReachedByThat)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.Heard("uav1", Modem, NodeState::UP, true, 5s);
    EXPECT_EQ(ChosenAt(5s), Modem);
    choice.Heard("uav1", Modem, NodeState::UP, false, 6s);
    EXPECT_EQ(ChosenAt(6s), Mesh);
}

TEST_F(PathChoiceTest, APathByWhichTheNodeDidNotHearThisOneForAMomentForgetsFailuresOfLongAgo)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    for (const PathChoice::Duration now : {5s, 7s, 9s, 11s, 13s, 15s})
    {
        FailMesh(now);
    }
    choice.Heard("uav1", Modem, NodeState::UP, true, 3600s);
    choice.Heard("uav1", Modem, NodeState::UP, false, 3601s);
    FailMesh(3605s);
    EXPECT_EQ(ChosenAt(3607s), Mesh);
}

TEST_F(PathChoiceTest, TellsWhichNodesAreHeardByALaterPathAlone)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    EXPECT_TRUE(choice.FirstHeardOn(Modem).empty());
    Hear(Mesh, NodeState::STALE, 5s);
    EXPECT_EQ(choice.FirstHeardOn(Modem), std::vector<std::string>{"uav1"});
    EXPECT_TRUE(choice.FirstHeardOn(Mesh).empty());
}

TEST_F(PathChoiceTest, AMissingAnswerChangesNothingIfThereIsNoOtherPath)
{
    Hear(Mesh, NodeState::UP, 0s);
    choice.Unanswered("uav1", 5s);
    EXPECT_EQ(ChosenAt(5s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 5s), std::nullopt);
}

TEST_F(PathChoiceTest, WhoSendsByAnotherPathIsAnsweredByBoth)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.CameBy("uav1", Modem, 5s);
    EXPECT_EQ(ChosenAt(5s), Mesh);
    EXPECT_EQ(choice.Second("uav1", 5s), Modem);
}

TEST_F(PathChoiceTest, MessagesByAnotherPathAreAnsweredByThatPathTooForAWhile)
{
    Hear(Mesh, NodeState::UP, 0s);
    Hear(Modem, NodeState::UP, 0s);
    choice.CameBy("uav1", Mesh, 5s);
    choice.MessageCameBy("uav1", Mesh, 5s);
    EXPECT_EQ(choice.Second("uav1", 5s, true), std::nullopt);
    choice.MessageCameBy("uav1", Modem, 5s);
    EXPECT_EQ(choice.Second("uav1", 5s, true), Modem);
    EXPECT_EQ(choice.Second("uav1", 5s, false), std::nullopt) << "messages need no second path";
    EXPECT_EQ(choice.Second("uav1", 5s + PathChoice::AnswersToo, true), std::nullopt);
}

TEST_F(PathChoiceTest, APathCarriesIfANodeIsReachedByIt)
{
    EXPECT_TRUE(choice.CarriesAny(Mesh)) << "before anybody is known";
    EXPECT_FALSE(choice.CarriesAny(Modem));
    Hear(Modem, NodeState::UP, 0s);
    EXPECT_TRUE(choice.CarriesAny(Modem));
    EXPECT_FALSE(choice.CarriesAny(Mesh));
}

TEST(PathChoiceOfOnePath, IsThatPath)
{
    PathChoice choice{1};
    choice.Heard("uav1", 0, NodeState::LOST, false, 0s);
    EXPECT_EQ(choice.Of("uav1"), 0U);
    EXPECT_TRUE(choice.CarriesAny(0));
}

}  // namespace
}  // namespace Rabit
