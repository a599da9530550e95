// Which full queues are problems, and whose.
#include "report/FullQueues.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/RabitMessage.h>

#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "BeatSamples.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Moment = std::chrono::nanoseconds;

class FullQueuesTest : public ::testing::Test
{
protected:
    FullQueuesTest()
    {
        fleet.node = "ground";
        fleet.incarnation = 7;
        HearUav();
    }

    // A beat of uav1, which is heard until it is LOST 3.5 s later.
    void HearUav()
    {
        HeardBeat heard;
        heard.Node = "uav1";
        heard.Incarnation = 5;
        heard.Beat = BeatAt(now);
        heard.Arrival = now;
        peers.OnBeat(heard);
    }

    QueueInfo &Full(const std::string &name)
    {
        return queues.emplace_back(QueueInfo{name, typeid(std::shared_ptr<RabitMessage>), 10, 10, 0});
    }
    Gateway::InboundStatus &HeldBack(const std::string &node, const std::string &queue)
    {
        Gateway::InboundStatus &stream = fleet.inbound.emplace_back();
        stream.node = node;
        stream.queue = queue;
        stream.held_back = true;
        return stream;
    }
    Gateway::LinkStatus &Waiting(const std::string &queue = "Commands")
    {
        Gateway::LinkStatus &link = fleet.links.emplace_back();
        link.node = "uav1";
        link.queue = queue;
        link.outbox = 5;
        return link;
    }

    std::vector<std::string> LookAfter(Moment time)
    {
        now += time;
        peers.Advance(now);
        std::vector<std::string> rows;
        for (const Gateway::Problem &problem : full.Look(queues, fleet, peers, now))
        {
            EXPECT_FALSE(problem.certain);
            rows.push_back((problem.node.empty() ? "" : problem.node + ": ") + problem.subject + ": " +
                           problem.reason);
        }
        return rows;
    }

    Moment now = 100s;
    PeerTable peers{"ground", 7};
    std::vector<QueueInfo> queues;
    Gateway::Fleet fleet;
    FullQueues full;
};

constexpr const char *Unread =
    "uav1: queue Commands: it is full (10 messages), and its manager takes no messages from it, or too few: "
    "those of `uav1` wait";

TEST_F(FullQueuesTest, AQueueThatNobodyReadsIsAProblemOnceMessagesWaitForThreeSeconds)
{
    Full("Commands");
    HeldBack("uav1", "Commands");
    EXPECT_THAT(LookAfter(0s), IsEmpty());
    EXPECT_THAT(LookAfter(3s - 1ns), IsEmpty());
    EXPECT_THAT(LookAfter(1ns), ElementsAre(Unread));
    queues[0].FillLevel = 9;
    EXPECT_THAT(LookAfter(1s), IsEmpty());
    queues[0].FillLevel = 10;
    EXPECT_THAT(LookAfter(1s), IsEmpty()) << "it had room in between";
}

TEST_F(FullQueuesTest, AFullQueueThatIsReadIsNoProblemToThoseWhoWait)
{
    Full("Commands");
    Gateway::InboundStatus &stream = HeldBack("uav1", "Commands");
    for (int i = 0; i < 20; ++i)
    {
        ++stream.delivered;
        EXPECT_THAT(LookAfter(2s), IsEmpty());
    }
}

TEST_F(FullQueuesTest, AFullQueueForWhichNothingWaitsIsNoProblem)
{
    Full("Commands").RefusedAdds = 5;
    LookAfter(0s);
    EXPECT_THAT(LookAfter(1min), IsEmpty());
}

TEST_F(FullQueuesTest, AFullQueueThatRefusesIsAProblemUntilTenSecondsAfterTheLastRefusal)
{
    QueueInfo &lines = Full("Lines");
    LookAfter(0s);
    lines.RefusedAdds = 24200;
    EXPECT_THAT(LookAfter(3s), ElementsAre("queue Lines: it is full (10 messages) and refuses messages: its "
                                           "manager takes none, or too few"));
    EXPECT_EQ(LookAfter(10s - 1ns).size(), 1u);
    EXPECT_THAT(LookAfter(1ns), IsEmpty());
}

TEST_F(FullQueuesTest, TheSenderIsToldOfAQueueOfAnotherNodeThatNobodyReads)
{
    Waiting().held_back = true;
    LookAfter(0s);
    now += 3s;
    HearUav();
    EXPECT_THAT(LookAfter(0s), ElementsAre("uav1: send uav1/Commands: messages wait: that queue is full, "
                                           "not there, or without memory for it"));
    fleet.links[0].refused_full = 3;
    ++fleet.links[0].expired;
    EXPECT_THAT(LookAfter(0s),
                ElementsAre("uav1: send uav1/Commands: no more messages may wait, and they "
                            "are refused: that queue is full, not there, or without memory for it"))
        << "a message that expires does not get on";
    ++fleet.links[0].delivered;
    EXPECT_THAT(LookAfter(0s), IsEmpty());
}

TEST_F(FullQueuesTest, AQueueThatIsNotHeldBackAtOneLookKeepsItsRow)
{
    Gateway::LinkStatus &link = Waiting();
    const auto rowsAfter = [&](Moment time, bool isHeld)
    {
        link.held_back = isHeld;
        now += time;
        HearUav();
        return LookAfter(0s).size();
    };
    rowsAfter(0s, true);
    EXPECT_EQ(rowsAfter(3s, true), 1u);
    EXPECT_EQ(rowsAfter(1s, false), 1u);
    EXPECT_EQ(rowsAfter(1s, true), 1u);
    EXPECT_EQ(rowsAfter(3s - 1ns, false), 1u);
    EXPECT_EQ(rowsAfter(1ns, false), 0u);
    EXPECT_EQ(rowsAfter(1s, true), 1u);
    ++link.delivered;
    EXPECT_EQ(rowsAfter(1s, false), 0u) << "a message got on";
}

TEST_F(FullQueuesTest, EachQueueOfAnotherNodeHasARowOfItsOwn)
{
    Waiting("Commands").held_back = true;
    Waiting("Notes");
    Waiting("Areas").held_back = true;
    LookAfter(0s);
    now += 3s;
    HearUav();
    EXPECT_THAT(LookAfter(0s), ElementsAre("uav1: send uav1/Commands: messages wait: that queue is full, "
                                           "not there, or without memory for it",
                                           "uav1: send uav1/Areas: messages wait: that queue is full, "
                                           "not there, or without memory for it"))
        << "messages for Notes are only on their way";
}

TEST_F(FullQueuesTest, MessagesThatWaitWithoutARefusalAreNoProblemOfASenderByThemselves)
{
    Waiting();
    LookAfter(0s);
    EXPECT_THAT(LookAfter(1min), IsEmpty()) << "uav1 is LOST, and has a row of its own";
}

TEST_F(FullQueuesTest, RefusedMessagesForALostNodeAreAProblem)
{
    Waiting().refused_full = 1;
    LookAfter(0s);
    EXPECT_THAT(LookAfter(4s), ElementsAre("uav1: send uav1/Commands: no more messages may wait, and they "
                                           "are refused: uav1 is LOST"));
}

TEST_F(FullQueuesTest, AFullOutboxIsAProblemIfALiveNodeTakesNothingForTenSeconds)
{
    Gateway::LinkStatus &link = Waiting();
    for (int second = 0; second < 10; ++second)
    {
        ++link.refused_full;
        HearUav();
        EXPECT_THAT(LookAfter(1s), IsEmpty());
    }
    HearUav();
    ++link.refused_full;
    EXPECT_THAT(LookAfter(1s), ElementsAre("uav1: send uav1/Commands: no more messages may wait, and they "
                                           "are refused: uav1 has taken none for more than 10 s"));
    for (int second = 0; second < 30; ++second)
    {
        ++link.refused_full;
        ++link.delivered;
        HearUav();
        EXPECT_THAT(LookAfter(1s), IsEmpty()) << "messages come faster than uav1 takes them";
    }
}

}  // namespace
}  // namespace Rabit
