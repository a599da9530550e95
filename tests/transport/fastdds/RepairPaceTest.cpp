// When what is known of our endpoints goes to all who lack it.
#include "RepairPace.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::FastDds::RepairPace;

constexpr std::uint64_t Writers = 1;
constexpr std::uint64_t Readers = 2;

class RepairPaceTest : public testing::Test
{
protected:
    // Somebody asks that often; the times at which it goes to all.
    std::vector<int> Ask(int from, int to, int step, std::uint64_t content = Writers)
    {
        std::vector<int> sent;
        int next = from;
        for (int at = from; at < to + 5000; ++at)
        {
            const auto now = Start + std::chrono::milliseconds(at);
            bool goes = Pace.Due() && *Pace.Due() <= now && !Pace.TakeDue(now).empty();
            if (at < to && at == next)
            {
                next += step;
                goes = Pace.MayGo(content, now) || goes;
            }
            if (goes)
            {
                sent.push_back(at);
            }
        }
        return sent;
    }

    RepairPace Pace;
    RepairPace::TimePoint Start{1h};
};

TEST_F(RepairPaceTest, WhoAsksFirstHasItSentAtOnceAndOnce)
{
    EXPECT_EQ(Ask(0, 1, 1), std::vector{0});
    EXPECT_FALSE(Pace.Due().has_value());
}

TEST_F(RepairPaceTest, ThoseWhoAskMeanwhileGetItTogether)
{
    EXPECT_EQ(Ask(0, 100, 10), (std::vector{0, 200}));
}

TEST_F(RepairPaceTest, RoundsFollowEachOtherAtDoublingDistances)
{
    EXPECT_EQ(Ask(0, 6000, 50), (std::vector{0, 200, 600, 1400, 3000, 4600, 6200}));
}

TEST_F(RepairPaceTest, AfterARestTheDistancesBeginAnew)
{
    Ask(0, 6000, 50);  // the last at 6200
    EXPECT_EQ(Ask(13000, 13100, 50), (std::vector{13000, 13200}));
}

TEST_F(RepairPaceTest, OneContentDoesNotHoldUpAnother)
{
    EXPECT_TRUE(Pace.MayGo(Writers, Start));
    EXPECT_TRUE(Pace.MayGo(Readers, Start));
    EXPECT_FALSE(Pace.MayGo(Writers, Start + 10ms));
    EXPECT_EQ(Pace.TakeDue(Start + 200ms), std::vector{Writers});
}

TEST_F(RepairPaceTest, ContentsWithoutEndDoNotFillTheMemory)
{
    for (std::uint64_t content = 0; content < 3 * RepairPace::MostContents; ++content)
    {
        EXPECT_TRUE(Pace.MayGo(content, Start));
    }
    EXPECT_LE(Pace.Size(), RepairPace::MostContents);
}

}  // namespace
