#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
constexpr PathChoice::Duration Period = 500ms;

// A node whose beats by each path are made one after another.
class PathChoiceTest : public ::testing::Test
{
protected:
    explicit PathChoiceTest(std::vector<double> budgets = {}) : choice(2, std::move(budgets))
    {
        for (const std::size_t path : {Mesh, Modem})
        {
            Hear(path, NodeState::UP);
            Beat(path);
        }
    }

    void Hear(std::size_t path, NodeState state, bool hearsHereFirst = false)
    {
        choice.Heard("uav1", path, state, hearsHereFirst);
    }
    // That many beats do not come by that path, and then one comes.
    void Beat(std::size_t path, std::uint64_t missed = 0)
    {
        numbers[path] += missed + 1;
        counts[path].Add(numbers[path]);
        choice.Look("uav1", path, {incarnation, counts[path], 0ms, Period});
    }
    void Beats(std::size_t path, int count)
    {
        for (int i = 0; i < count; ++i)
        {
            Beat(path);
        }
    }
    // The next beat by that path is overdue for this time.
    void Silent(std::size_t path, PathChoice::Duration overdue)
    {
        choice.Look("uav1", path, {incarnation, counts[path], overdue, Period});
    }
    void StartAgain(std::size_t path)
    {
        ++incarnation;
        counts = {};
        Beat(path);
    }
    std::size_t Chosen()
    {
        changed = choice.TakeChanged();
        return choice.Of("uav1");
    }
    bool HasSecond(PathChoice::Duration now = 5s) { return choice.Second("uav1", now).has_value(); }

    PathChoice choice;
    std::vector<std::string> changed;
    std::uint64_t incarnation = 1;
    std::array<BeatCount, 2> counts;
    std::array<std::uint64_t, 2> numbers{};
};

TEST_F(PathChoiceTest, ANodeIsReachedByTheFirstPathOnWhichItIsUp)
{
    Hear(Mesh, NodeState::STALE);
    EXPECT_EQ(Chosen(), Modem);
    Hear(Mesh, NodeState::UP);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_EQ(changed, std::vector<std::string>{"uav1"});
}

TEST_F(PathChoiceTest, APathIsLeftWhenFourBeatsAreOverdue)
{
    Silent(Mesh, 4 * Period);
    EXPECT_EQ(Chosen(), Mesh);
    Silent(Mesh, 4 * Period + 1ms);
    EXPECT_EQ(Chosen(), Modem);
}

TEST_F(PathChoiceTest, APathThatReturnsIsTakenWhenItOwesLessThanABeat)
{
    Silent(Mesh, 5 * Period);
    EXPECT_EQ(Chosen(), Modem);
    Beat(Mesh, 3);
    EXPECT_EQ(Chosen(), Modem);
    Beats(Mesh, 2);
    EXPECT_EQ(Chosen(), Modem);
    Beat(Mesh);
    EXPECT_EQ(Chosen(), Mesh);
}

TEST_F(PathChoiceTest, APathThatComesAndGoesIsLeftAlone)
{
    for (int i = 0; i < 5; ++i)
    {
        Beat(Mesh, 3);
        Beats(Mesh, 2);
    }
    for (int i = 0; i < 20; ++i)
    {
        Beat(Mesh, 3);
        EXPECT_EQ(Chosen(), Modem);
        Beats(Mesh, 2);
        EXPECT_EQ(Chosen(), Modem);
    }
}

TEST_F(PathChoiceTest, NoDebtIsLargerThanFourteenBeatsEnd)
{
    Beat(Mesh, 5000);
    EXPECT_EQ(Chosen(), Modem);
    Beats(Mesh, 13);
    EXPECT_EQ(Chosen(), Mesh);
}

TEST_F(PathChoiceTest, IfAllPathsAreDeadTheLastOneStays)
{
    Hear(Mesh, NodeState::LOST);
    EXPECT_EQ(Chosen(), Modem);
    Hear(Modem, NodeState::LOST);
    EXPECT_EQ(Chosen(), Modem);
}

TEST_F(PathChoiceTest, APathInDebtIsBetterThanNone)
{
    Beat(Mesh, 8);
    EXPECT_EQ(Chosen(), Modem);
    Hear(Modem, NodeState::LOST);
    EXPECT_EQ(Chosen(), Mesh);
}

TEST_F(PathChoiceTest, WhileAnAnswerIsMissingFramesGoByBothPaths)
{
    EXPECT_FALSE(HasSecond());
    EXPECT_TRUE(choice.Unanswered("uav1", 5s));
    EXPECT_FALSE(choice.Unanswered("uav1", 6s)) << "the same doubt";
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_EQ(choice.Second("uav1", 6s + PathChoice::Both - 1ms), Modem);
    EXPECT_EQ(choice.Second("uav1", 6s + PathChoice::Both), std::nullopt);
    EXPECT_TRUE(choice.Unanswered("uav1", 6s + PathChoice::Both));
}

TEST_F(PathChoiceTest, ANodeWhoseFramesComeByAnotherPathAloneIsReachedByBoth)
{
    choice.CameBy("uav1", Mesh, 5s);
    choice.CameBy("uav1", Modem, 5050ms);
    EXPECT_FALSE(HasSecond(5050ms)) << "one came by the mesh a moment ago";
    choice.CameBy("uav1", Modem, 5s + PathChoice::Silence);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_TRUE(HasSecond(5s + PathChoice::Silence + PathChoice::Both - 1ms));
    EXPECT_FALSE(HasSecond(5s + PathChoice::Silence + PathChoice::Both));
}

TEST_F(PathChoiceTest, ADeadNodeHasNoSecondPath)
{
    choice.Unanswered("uav1", 5s);
    Hear(Modem, NodeState::LOST);
    EXPECT_FALSE(HasSecond(6s));
    Hear(Mesh, NodeState::LOST);
    EXPECT_FALSE(choice.Unanswered("uav1", 8s));
    EXPECT_FALSE(HasSecond(8s));
    EXPECT_FALSE(choice.IsSecondOfAny(Modem, 8s));
}

TEST(PathChoiceOfThreePaths, TakesAnotherSecondPathIfThatOneDies)
{
    PathChoice choice{3};
    for (const std::size_t path : {0U, 1U, 2U})
    {
        choice.Heard("uav1", path, NodeState::UP, false);
    }
    choice.Unanswered("uav1", 5s);
    EXPECT_EQ(choice.Second("uav1", 5s), 1U);
    choice.Heard("uav1", 1, NodeState::LOST, false);
    EXPECT_EQ(choice.Second("uav1", 5500ms), 2U);
}

TEST_F(PathChoiceTest, APathIsUsedWithAnotherWhileABeatIsLate)
{
    Silent(Mesh, Period / 4);
    EXPECT_FALSE(HasSecond());
    Silent(Mesh, Period / 4 + 1ms);
    EXPECT_EQ(choice.Second("uav1", 5s), Modem);
    EXPECT_TRUE(choice.IsSecondOfAny(Modem, 5s));
    EXPECT_EQ(Chosen(), Mesh);
    Beat(Mesh);
    EXPECT_FALSE(HasSecond());
}

TEST_F(PathChoiceTest, APathThatFailedIsUsedWithAnotherUntilItsDebtIsPaid)
{
    Beat(Mesh, 5);
    EXPECT_EQ(Chosen(), Modem);
    Beats(Mesh, 7);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_TRUE(HasSecond());
    Beats(Mesh, 2);
    EXPECT_FALSE(HasSecond());
}

TEST_F(PathChoiceTest, IfAllPathsAreInDebtNoneIsUsedWithAnother)
{
    Beat(Mesh, 6);
    Beat(Modem, 6);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_FALSE(HasSecond());
}

TEST_F(PathChoiceTest, ANodeThatStartsAgainOwesNothing)
{
    for (int i = 0; i < 10; ++i)
    {
        Silent(Mesh, 5 * Period);
        Silent(Modem, 5 * Period);
        Hear(Mesh, NodeState::STALE);
        EXPECT_EQ(Chosen(), Modem) << "whose beats are rarer";
        StartAgain(Mesh);
        Hear(Mesh, NodeState::UP);
        EXPECT_EQ(Chosen(), Mesh);
        EXPECT_FALSE(HasSecond());
        Beat(Modem);
    }
}

TEST_F(PathChoiceTest, BeatsOfAnEarlierLifeOweAll)
{
    StartAgain(Modem);
    BeatCount old;
    old.Add(100);
    choice.Look("uav1", Mesh, {incarnation - 1, old, 0ms, Period});
    EXPECT_EQ(Chosen(), Modem);
}

// Its clock was set back, and it keeps no state.
TEST_F(PathChoiceTest, ANodeThatComesBackWithALowerIncarnationIsJudgedByItsBeats)
{
    incarnation = 9;
    Beat(Mesh);
    Beat(Modem);
    Hear(Mesh, NodeState::LOST);
    Hear(Modem, NodeState::LOST);
    incarnation = 2;
    counts = {};
    for (const std::size_t path : {Mesh, Modem})
    {
        Hear(path, NodeState::UP);
        Beat(path);
    }
    Silent(Mesh, 5 * Period);
    EXPECT_EQ(Chosen(), Modem);
}

class PathChoiceOfABigAndASmallPath : public PathChoiceTest
{
protected:
    PathChoiceOfABigAndASmallPath() : PathChoiceTest({1e6, 1500}) {}
};

TEST_F(PathChoiceOfABigAndASmallPath, TheBigOneMayOweMore)
{
    Beat(Mesh, 6);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_TRUE(HasSecond());
}

TEST_F(PathChoiceOfABigAndASmallPath, TheBigOneIsTakenAgainSoonAfterALongSilence)
{
    Hear(Mesh, NodeState::STALE);
    EXPECT_EQ(Chosen(), Modem);
    Beat(Mesh, 100);
    Hear(Mesh, NodeState::UP);
    EXPECT_EQ(Chosen(), Modem);
    Beats(Mesh, 5);
    EXPECT_EQ(Chosen(), Mesh);
}

TEST_F(PathChoiceTest, ALossyPathIsKeptIfTheOtherLosesAsMuch)
{
    for (int i = 0; i < 10; ++i)
    {
        Beat(Mesh, 2);
        Beat(Modem, 2);
        EXPECT_EQ(Chosen(), Mesh);
    }
}

TEST_F(PathChoiceTest, APathThatLosesABeatInFourIsKept)
{
    for (int i = 0; i < 100; ++i)
    {
        Beat(Mesh, 1);
        Beats(Mesh, 2);
        EXPECT_EQ(Chosen(), Mesh);
    }
}

TEST_F(PathChoiceTest, WhileBothEndsLeaveAPathEachTellsTheOtherWhenItHearsWellAgain)
{
    Beat(Mesh, 5);
    Hear(Modem, NodeState::UP, true);
    EXPECT_EQ(Chosen(), Modem);
    EXPECT_TRUE(choice.TakeFirstHeardChanged());
    EXPECT_EQ(choice.FirstHeardOn(Modem), std::vector<std::string>{"uav1"});
    Beats(Mesh, 7);
    EXPECT_EQ(Chosen(), Modem);
    EXPECT_TRUE(choice.TakeFirstHeardChanged());
    EXPECT_TRUE(choice.FirstHeardOn(Modem).empty());
}

TEST_F(PathChoiceTest, ANodeThatHearsThisOneByALaterPathAloneIsReachedByThat)
{
    Hear(Modem, NodeState::UP, true);
    EXPECT_EQ(Chosen(), Modem);
    Hear(Modem, NodeState::UP, false);
    EXPECT_EQ(Chosen(), Mesh);
    EXPECT_TRUE(HasSecond()) << "until two beats more have come";
    Beats(Mesh, 2);
    EXPECT_FALSE(HasSecond());
}

TEST_F(PathChoiceTest, APathIsKeptThoughTheOneThatTheNodeDoesNotHearOwesLess)
{
    Hear(Modem, NodeState::UP, true);
    Beat(Modem, 8);
    EXPECT_EQ(Chosen(), Modem);
}

TEST_F(PathChoiceTest, TellsWhichNodesAreHeardByALaterPathAlone)
{
    static_cast<void>(Chosen());
    EXPECT_TRUE(choice.FirstHeardOn(Modem).empty());
    Hear(Mesh, NodeState::STALE);
    static_cast<void>(Chosen());
    EXPECT_EQ(choice.FirstHeardOn(Modem), std::vector<std::string>{"uav1"});
    EXPECT_TRUE(choice.FirstHeardOn(Mesh).empty());
}

TEST_F(PathChoiceTest, MessagesByAnotherPathAreAnsweredByThatPathTooForAWhile)
{
    choice.MessageCameBy("uav1", Mesh, 5s);
    EXPECT_EQ(choice.Second("uav1", 5s, true), std::nullopt);
    choice.MessageCameBy("uav1", Modem, 5s);
    EXPECT_EQ(choice.Second("uav1", 5s, true), Modem);
    EXPECT_EQ(choice.Second("uav1", 5s, false), std::nullopt) << "messages need no second path";
    EXPECT_EQ(choice.Second("uav1", 5s + PathChoice::AnswersToo, true), std::nullopt);
}

TEST(PathChoiceOfNobody, TheFirstPathCarries)
{
    PathChoice choice{2};
    EXPECT_TRUE(choice.CarriesAny(Mesh));
    EXPECT_FALSE(choice.CarriesAny(Modem));
    choice.Heard("uav1", Modem, NodeState::UP, false);
    EXPECT_EQ(choice.TakeChanged(), std::vector<std::string>{"uav1"});
    EXPECT_TRUE(choice.CarriesAny(Modem));
    EXPECT_FALSE(choice.CarriesAny(Mesh));
}

TEST(PathChoiceOfOnePath, IsThatPath)
{
    PathChoice choice{1};
    choice.Heard("uav1", 0, NodeState::LOST, false);
    EXPECT_EQ(choice.Of("uav1"), 0U);
    EXPECT_TRUE(choice.CarriesAny(0));
}

}  // namespace
}  // namespace Rabit
