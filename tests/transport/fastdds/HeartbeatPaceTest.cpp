// How often a heartbeat without news goes out.
#include "HeartbeatPace.h"

#include <gtest/gtest.h>

#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::FastDds::HeartbeatPace;
using Rabit::FastDds::LoneHeartbeat;
using Rabit::Rtps::PublicationsWriter;

constexpr std::uint64_t Group = 1;
constexpr std::uint64_t Elsewhere = 2;

class HeartbeatPaceTest : public testing::Test
{
protected:
    // Offers the heartbeat as often as the vendor does. Returns the times at which it goes, in ms from the
    // start.
    std::vector<int> Say(int from, int to, int step, const LoneHeartbeat &heartbeat,
                         std::uint64_t destination = Group)
    {
        std::vector<int> sent;
        for (int at = from; at < to; at += step)
        {
            if (Pace.MayGo(destination, heartbeat, Start + std::chrono::milliseconds(at)))
            {
                sent.push_back(at);
            }
        }
        return sent;
    }
    void Acknowledge(int at, std::int64_t base, bool asks, const GuidPrefix &peer = Sender)
    {
        Pace.OnAcknowledgement({peer, UserReader, UserWriter, base, asks},
                               Start + std::chrono::milliseconds(at));
    }

    HeartbeatPace Pace;
    HeartbeatPace::TimePoint Start{1h};
    const LoneHeartbeat ToAll{{}, UserWriter, 1, 5};
};

TEST_F(HeartbeatPaceTest, OfAnUnansweredOneRepetitionsFollowAtDoublingDistances)
{
    EXPECT_EQ(Say(0, 10000, 20, ToAll),
              (std::vector{0, 20, 60, 140, 300, 620, 1260, 2260, 3260, 4260, 5260, 6260, 7260, 8260, 9260}));
}

TEST_F(HeartbeatPaceTest, ThoseOfDiscoveryAtGreaterOnes)
{
    EXPECT_EQ(Say(0, 20000, 1000, {{}, PublicationsWriter, 1, 5}),
              (std::vector{0, 1000, 3000, 7000, 11000, 15000, 19000}));
}

TEST_F(HeartbeatPaceTest, OneWithOtherNumbersGoesAtOnce)
{
    Say(0, 5000, 20, ToAll);
    EXPECT_EQ(Say(5000, 5100, 20, {{}, UserWriter, 1, 6}), (std::vector{5000, 5020, 5060}));
    EXPECT_EQ(Say(5100, 5120, 20, {{}, UserWriter, 2, 6}), std::vector{5100});
}

TEST_F(HeartbeatPaceTest, OneToANewcomerGoesAtOnce)
{
    Say(0, 5000, 20, ToAll);
    EXPECT_EQ(Say(5000, 5001, 20, {Sender, UserWriter, 1, 5}, Elsewhere), std::vector{5000});
    EXPECT_EQ(Say(5000, 5001, 20, {Other, UserWriter, 1, 5}, Elsewhere), std::vector{5000});
}

TEST_F(HeartbeatPaceTest, OneWriterDoesNotHoldUpAnother)
{
    Say(0, 5000, 20, ToAll);
    EXPECT_EQ(Say(5000, 5001, 20, {{}, UserWriter + 0x100, 1, 5}), std::vector{5000});
}

TEST_F(HeartbeatPaceTest, WhoAcknowledgesMoreHasTheDistancesBeginAnew)
{
    Say(0, 5000, 20, ToAll);  // the last at 4260
    Acknowledge(5000, 3, false);
    EXPECT_EQ(Say(5000, 5200, 20, ToAll), (std::vector{5020, 5060, 5140}));
}

TEST_F(HeartbeatPaceTest, WhoAcknowledgesTheSameAgainDoesNot)
{
    Acknowledge(0, 3, false);
    Say(0, 5000, 20, ToAll);
    Acknowledge(5000, 3, false);
    EXPECT_EQ(Say(5000, 6000, 20, ToAll), std::vector{5260});
}

TEST_F(HeartbeatPaceTest, WhoAsksIsAnsweredAtOnce)
{
    const LoneHeartbeat toOne{Sender, UserWriter, 1, 5};
    Acknowledge(0, 3, false);
    Say(0, 5000, 20, toOne, Elsewhere);
    Acknowledge(5000, 3, true);
    EXPECT_EQ(Say(5000, 5010, 20, toOne, Elsewhere), std::vector{5000});
}

TEST_F(HeartbeatPaceTest, PeersWithoutEndDoNotFillTheMemory)
{
    for (std::uint64_t i = 0; i < 3 * HeartbeatPace::Most; ++i)
    {
        EXPECT_TRUE(Pace.MayGo(i, ToAll, Start));
        Pace.OnAcknowledgement({Sender, static_cast<Rabit::Rtps::EntityId>(i), UserWriter, 1, true}, Start);
    }
    EXPECT_LE(Pace.Size(), HeartbeatPace::Most);
}

}  // namespace
