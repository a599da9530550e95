#include "report/ProblemLog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Gateway::Problem Of(const std::string &subject, const std::string &node, const std::string &reason)
{
    Gateway::Problem problem;
    problem.subject = subject;
    problem.node = node;
    problem.reason = reason;
    return problem;
}

const Gateway::Problem Misspelt = Of("subscribe Pse", "uav1", "uav1 does not publish `Pse`");
constexpr const char *MisspeltLine = "subscribe Pse, uav1: uav1 does not publish `Pse`";
constexpr const char *MisspeltGone = "no longer: subscribe Pse, uav1: uav1 does not publish `Pse`";

class ProblemLogTest : public testing::Test
{
protected:
    using Problems = std::vector<Gateway::Problem>;

    // Looks every 500 ms for `duration`, with the same problems each time. Returns the lines.
    std::vector<std::string> For(std::chrono::milliseconds duration, const Problems &present)
    {
        std::vector<std::string> lines;
        for (const auto end = _now + duration; _now < end; _now += 500ms)
        {
            for (const std::string &line : _log.Look(present, _now))
            {
                lines.push_back(line);
            }
        }
        return lines;
    }

    // The problems are there for four seconds, then gone for four seconds.
    std::vector<std::string> ComeAndGo(const Problems &present)
    {
        std::vector<std::string> lines = For(4s, present);
        for (const std::string &line : For(4s, {}))
        {
            lines.push_back(line);
        }
        return lines;
    }

    ProblemLog _log{"Gateway/Fleet"};
    std::chrono::nanoseconds _now = 1000s;
};

TEST_F(ProblemLogTest, TellsAProblemOnceWhenItHasLasted)
{
    EXPECT_THAT(For(2s, {Misspelt}), IsEmpty());
    EXPECT_THAT(For(500ms, {Misspelt}), ElementsAre(MisspeltLine));
    EXPECT_THAT(For(1h, {Misspelt}), IsEmpty());
}

TEST_F(ProblemLogTest, TellsACertainProblemAtOnceAndNoMoreOftenThanAnother)
{
    Gateway::Problem version = Misspelt;
    version.certain = true;
    EXPECT_THAT(For(500ms, {version}), ElementsAre(MisspeltLine));
    EXPECT_THAT(For(1h, {version}), IsEmpty());
    EXPECT_THAT(For(3s, {}), ElementsAre(MisspeltGone));
    std::size_t lines = 0;
    for (int second = 0; second < 60; ++second)
    {
        lines += For(500ms, {version}).size() + For(500ms, {}).size();
    }
    EXPECT_LE(lines, 3u);
}

TEST_F(ProblemLogTest, TellsOnceMoreWhenItHasBeenGoneAsLong)
{
    For(3s, {Misspelt});
    EXPECT_THAT(For(2s, {}), IsEmpty());
    EXPECT_THAT(For(500ms, {}), ElementsAre(MisspeltGone));
    EXPECT_THAT(For(1h, {}), IsEmpty());
}

TEST_F(ProblemLogTest, IsSilentAboutAProblemThatPasses)
{
    EXPECT_THAT(For(2s, {Misspelt}), IsEmpty());
    EXPECT_THAT(For(1h, {}), IsEmpty());
}

TEST_F(ProblemLogTest, DoesNotCountHowOftenAProblemPassedBeforeItWasToldFirst)
{
    For(1s, {Misspelt});
    For(3s, {});
    EXPECT_THAT(For(3s, {Misspelt}), ElementsAre(MisspeltLine));
}

TEST_F(ProblemLogTest, CountsFromWhenAProblemWasThereFirstAndNotFromAnEarlierOne)
{
    For(1500ms, {Misspelt});
    For(10s, {});
    EXPECT_THAT(For(2s, {Misspelt}), IsEmpty());
    EXPECT_THAT(For(500ms, {Misspelt}), ElementsAre(MisspeltLine));
}

TEST_F(ProblemLogTest, TakesAProblemThatComesAndGoesQuicklyForOneThatIsThere)
{
    std::vector<std::string> lines;
    for (int i = 0; i < 100; ++i)
    {
        for (const Problems &present : {Problems{Misspelt}, Problems{}})
        {
            for (const std::string &line : For(1s, present))
            {
                lines.push_back(line);
            }
        }
    }
    EXPECT_THAT(lines, ElementsAre(MisspeltLine));
}

TEST_F(ProblemLogTest, TakesTextsThatDifferOnlyInNumbersForOneProblem)
{
    std::vector<std::string> lines;
    for (int i = 0; i < 200; ++i)
    {
        const std::string reason = std::to_string(i * 7) + " of " + std::to_string(i * 0.37) + " s are late";
        for (const std::string &line : For(500ms, {Of("subscribe Pose", "uav1", reason)}))
        {
            lines.push_back(line);
        }
    }
    EXPECT_THAT(lines, ElementsAre("subscribe Pose, uav1: 28 of 1.480000 s are late"));
}

TEST_F(ProblemLogTest, TellsTheReasonThatTakesThePlaceOfAnotherOneButNoEnd)
{
    For(3s, {Of("subscribe Pose", "uav1", "no announcement of uav1 has arrived yet")});
    EXPECT_THAT(For(1min, {Of("subscribe Pose", "uav1", "uav1 does not publish `Pose`")}),
                ElementsAre("subscribe Pose, uav1: uav1 does not publish `Pose`"));
    EXPECT_THAT(For(1min, {}), ElementsAre("no longer: subscribe Pose, uav1: uav1 does not publish `Pose`"));
}

TEST_F(ProblemLogTest, SaysWhatBeginsTogetherForOneReasonInOneLine)
{
    const Problems problems = {Of("subscribe Pose", "", "no node named `*` has been heard"),
                               Of("subscribe Health", "", "no node named `*` has been heard"),
                               Of("accept Commands", "", "there is no local queue `Commands`")};
    EXPECT_THAT(For(3s, problems), ElementsAre("subscribe Pose, Health: no node named `*` has been heard",
                                               "accept Commands: there is no local queue `Commands`"));
    EXPECT_THAT(For(3s, {problems[2]}),
                ElementsAre("no longer: subscribe Health, Pose: no node named `*` has been heard"));
}

TEST_F(ProblemLogTest, KeepsReasonsApartThatDifferInANumber)
{
    EXPECT_THAT(For(3s, {Of("subscribe Pose", "", "no node named `uav1` has been heard"),
                         Of("subscribe Health", "", "no node named `uav2` has been heard")}),
                ElementsAre("subscribe Pose: no node named `uav1` has been heard",
                            "subscribe Health: no node named `uav2` has been heard"));
}

TEST_F(ProblemLogTest, ListsTheFirstOfManySubjects)
{
    Problems problems;
    for (int i = 0; i < 9; ++i)
    {
        problems.push_back(Of("subscribe M" + std::to_string(i), "", "no node"));
    }
    EXPECT_THAT(For(3s, problems), ElementsAre("subscribe M0, M1, M2, M3, M4, M5 and 3 more: no node"));
}

TEST_F(ProblemLogTest, DoesNotNameTheNodeTwiceInFrontOfTheReason)
{
    EXPECT_THAT(For(3s, {Of("send uav9/Nowhere", "uav9", "no node named `uav9` has been heard")}),
                ElementsAre("send uav9/Nowhere: no node named `uav9` has been heard"));
}

TEST_F(ProblemLogTest, TellsAProblemThatKeepsComingBackSeldom)
{
    std::vector<std::string> lines;
    for (int i = 0; i < 450; ++i)  // an hour
    {
        for (const std::string &line : ComeAndGo({Misspelt}))
        {
            lines.push_back(line);
        }
    }
    // Three problems at once and one a minute, each with a line for its end.
    EXPECT_LE(lines.size(), 2u * (3 + 60));
    EXPECT_GE(lines.size(), 2u * 50);
    EXPECT_EQ(lines[0], MisspeltLine);
    EXPECT_EQ(lines[1], MisspeltGone);
    EXPECT_THAT(lines[lines.size() - 2], HasSubstr(" times since this was said last)"));
}

TEST_F(ProblemLogTest, TellsAProblemAtOnceAgainAfterAQuietTime)
{
    for (int i = 0; i < 10; ++i)
    {
        ComeAndGo({Misspelt});
    }
    For(5min, {});
    EXPECT_THAT(ComeAndGo({Misspelt}), ElementsAre(MisspeltLine, MisspeltGone));
}

TEST_F(ProblemLogTest, TellsInTheEndAProblemThatStaysAfterItCameTooOften)
{
    for (int i = 0; i < 5; ++i)
    {
        ComeAndGo({Misspelt});
    }
    EXPECT_THAT(For(2min, {Misspelt}), SizeIs(1));
}

TEST_F(ProblemLogTest, TellsAFloodOfProblemsSlowlyAndSaysThatThereAreMore)
{
    Problems problems;
    for (int i = 0; i < 100; ++i)
    {
        problems.push_back(Of("subscribe Pose", "uav" + std::to_string(i), "nothing"));
    }
    const auto first = For(2500ms, problems);
    EXPECT_THAT(first, SizeIs(ProblemLog::LinesAtOnce + 1));
    EXPECT_EQ(first.back(), "60 more problems; Gateway/Fleet lists all");
    EXPECT_THAT(For(1min, problems), SizeIs(6));
    EXPECT_THAT(For(1h, problems), SizeIs(54)) << "each is told in the end";
}

TEST_F(ProblemLogTest, FollowsABoundedNumberOfProblems)
{
    Problems problems;
    for (std::size_t i = 0; i < ProblemLog::MostFollowed + 500; ++i)
    {
        problems.push_back(Of("send x" + std::to_string(i) + "/Q", "", "nobody"));
    }
    const auto lines = For(3s, problems);
    EXPECT_EQ(lines.front(), "500 more problems; Gateway/Fleet lists all");
    EXPECT_THAT(lines.back(), HasSubstr("send x0/Q, x1/Q"));
    EXPECT_THAT(lines.back(), HasSubstr(" and 994 more: nobody"));
}

TEST_F(ProblemLogTest, MakesRoomForNewProblemsByThoseThatAreLongGone)
{
    for (std::size_t i = 0; i < 2 * ProblemLog::MostFollowed; ++i)
    {
        For(500ms, {Of("send x" + std::to_string(i) + "/Q", "", "nobody")});
    }
    EXPECT_THAT(For(3s, {Misspelt}), ElementsAre(MisspeltLine));
}

TEST_F(ProblemLogTest, KeepsToOneLineWhateverTheNetworkSays)
{
    const auto lines = For(3s, {Of("subscribe Pose", "uav1", "\x1b[2J\n\xff" + std::string(100'000, 'x'))});
    ASSERT_THAT(lines, SizeIs(1));
    EXPECT_THAT(lines[0], HasSubstr("subscribe Pose, uav1: ?[2J??xxx"));
    EXPECT_EQ(lines[0].size(), ProblemLog::LongestLine);
}

TEST_F(ProblemLogTest, TellsAtTheEndWhatWasNotTold)
{
    const Gateway::Problem refused = Of("send uav9/Q", "uav9", "not known");
    For(3s, {Misspelt});
    EXPECT_THAT(_log.AtEnd({Misspelt, refused}), ElementsAre("send uav9/Q: not known"));
}

TEST_F(ProblemLogTest, IsNotMisledByATimeWithoutLooks)
{
    For(3s, {Misspelt});
    _now += 25s;  // the process was stopped
    EXPECT_THAT(For(3s, {Misspelt}), IsEmpty());
    _now += 25s;
    EXPECT_THAT(For(1s, {}), IsEmpty()) << "it may be back as soon as the others are heard again";
    EXPECT_THAT(For(1min, {Misspelt}), IsEmpty());
}

}  // namespace
}  // namespace Rabit
