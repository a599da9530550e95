// Which States a node requests, and when.
#include "mirrors/StateRepair.h"

#include <gmock/gmock.h>

#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "mirrors/StateVersion.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;
using testing::ElementsAre;

// Source time of the other nodes' clocks when this node's clock shows 0.
constexpr std::int64_t Epoch = 1'700'000'000'000'000'000;
// The time after which versions repeat.
constexpr Ns Round{StateVersion::Step << 32};

class StateRepairTest : public testing::Test
{
protected:
    // Source time of a State that is posted at `when`.
    static std::int64_t At(Ns when) { return StateVersion::Quantised(Epoch + when.count()); }

    // Announces two States that this node wants, and one between them that it does not.
    void Announce(const std::string &node, std::uint64_t incarnation = 1)
    {
        repair.SetWanted(node, incarnation,
                         {{.State = 0, .Subscription = 10}, {.State = 2, .Subscription = 12}});
    }

    // A beat states when the States of the node were posted; negative: never.
    void Tell(const std::string &node, const std::vector<Ns> &posted, Ns now, std::uint64_t incarnation = 1,
              Ns roundTrip = 0ns, std::size_t others = 0)
    {
        std::vector<std::uint32_t> versions;
        for (const Ns when : posted)
        {
            versions.push_back(when < 0ns ? 0 : StateVersion::Of(At(when)));
        }
        repair.OnTold(node,
                      {.Incarnation = incarnation,
                       .Versions = versions,
                       .SourceNow = Epoch + now.count(),
                       .RoundTrip = roundTrip,
                       .Others = others},
                      now);
    }

    void Have(const std::string &node, std::size_t subscription, Ns posted, std::uint64_t incarnation = 1)
    {
        taken[{node, incarnation, subscription}] = At(posted);
    }

    // Returns "node:places" of all requests that change now, with a `!` if the beat is to come soon.
    std::vector<std::string> Take(Ns now)
    {
        std::vector<std::string> asks;
        for (const StateRepair::Ask &ask : repair.Take(now))
        {
            std::ostringstream text;
            text << ask.Node << ":";
            for (std::size_t place = 0; place < ask.States.size(); ++place)
            {
                if (ask.States[place])
                {
                    text << ' ' << place;
                }
            }
            text << (ask.Now ? " !" : "");
            asks.push_back(text.str());
        }
        return asks;
    }

    // The node is heard, and this node has all its States.
    void Settled(const std::string &node)
    {
        Announce(node);
        Have(node, 10, 1s);
        Have(node, 12, 1s);
        Tell(node, {1s, 1s, 1s}, 2s);
        EXPECT_THAT(Take(2s), ElementsAre());
    }

    std::map<std::tuple<std::string, std::uint64_t, std::size_t>, std::int64_t> taken;
    std::uint64_t random = 0;
    StateRepair repair{[this](const std::string &node, std::uint64_t incarnation, std::size_t subscription)
                       {
                           const auto found = taken.find({node, incarnation, subscription});
                           return found == taken.end() ? std::nullopt : std::optional(found->second);
                       },
                       [this] { return random; }};
};

TEST_F(StateRepairTest, ANodeThatIsHeardForTheFirstTimeIsAskedAtOnceForAllThatIsWanted)
{
    Announce("uav1");
    EXPECT_FALSE(repair.Due());
    Tell("uav1", {1s, 1s, 1s}, 10s);
    EXPECT_EQ(repair.Due(), 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 2 !"));
}

TEST_F(StateRepairTest, WhatIsThereIsNotAskedFor)
{
    Settled("uav1");
    EXPECT_FALSE(repair.Due());
    for (Ns now = 2s; now < 200s; now += 500ms)
    {
        Tell("uav1", {1s, 1s, 1s}, now);
        EXPECT_THAT(Take(now), ElementsAre());
    }
}

TEST_F(StateRepairTest, WhatWasNeverWrittenIsNotAskedFor)
{
    Announce("uav1");
    Tell("uav1", {-1s, 1s, -1s}, 10s);
    EXPECT_FALSE(repair.Due());
    Tell("uav1", {-1s}, 11s);
    EXPECT_FALSE(repair.Due()) << "the last was not told";
    EXPECT_THAT(Take(20s), ElementsAre());
}

TEST_F(StateRepairTest, ASampleThatMayBeOnItsWayIsGivenTime)
{
    Settled("uav1");
    Tell("uav1", {3s, 1s, 1s}, 3s);
    EXPECT_EQ(repair.Due(), 3s + StateRepair::AskAfter);
    EXPECT_THAT(Take(3s + StateRepair::AskAfter - 1ns), ElementsAre());
    EXPECT_THAT(Take(3s + StateRepair::AskAfter), ElementsAre("uav1: 0 !"));
}

TEST_F(StateRepairTest, ASampleThatComesInTimeIsNotAskedFor)
{
    Settled("uav1");
    Tell("uav1", {3s, 1s, 1s}, 3s);
    Have("uav1", 10, 3s);
    EXPECT_THAT(Take(4s), ElementsAre());
    EXPECT_FALSE(repair.Due());
}

TEST_F(StateRepairTest, ASampleThatIsNewerThanTheBeatIsNoLack)
{
    Settled("uav1");
    Have("uav1", 10, 3s);
    Tell("uav1", {1s, 1s, 1s}, 3100ms);
    EXPECT_FALSE(repair.Due());
}

// A version alone does not tell the order. A stated version is older than now: its latest fitting time is
// no newer than the accepted sample, or the sample is lacking.
TEST_F(StateRepairTest, VersionsThatCameAgainAreToldApart)
{
    Settled("uav1");
    // Nothing is posted for longer than half a round, so a version whose number is ahead by less than half
    // is later.
    const Ns later = 1s + Round / 2 + 60s;
    Tell("uav1", {later, 1s, 1s}, later + 1s);
    EXPECT_THAT(Take(later + 2s), ElementsAre("uav1: 0 !"));
    Have("uav1", 10, later);
    EXPECT_THAT(Take(later + 3s), ElementsAre("uav1:"));
    // Nothing at all is posted for longer than a round.
    Tell("uav1", {later, 1s, 1s}, later + Round + 1s);
    EXPECT_FALSE(repair.Due());
}

TEST_F(StateRepairTest, WhatIsAskedIsAskedInEachBeatUntilItIsThere)
{
    Announce("uav1");
    Have("uav1", 12, 1s);
    Tell("uav1", {1s, 1s, 1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 !"));
    EXPECT_THAT(Take(10s + 1ms), ElementsAre()) << "it has been said";
    Have("uav1", 10, 1s);
    Tell("uav1", {1s, 1s, 1s}, 10s + 2ms);
    EXPECT_FALSE(repair.Due());
    EXPECT_FALSE(repair.IsIdle()) << "that has to be said";
    EXPECT_THAT(Take(10s + 2ms), ElementsAre("uav1:"));
    EXPECT_TRUE(repair.IsIdle());
    EXPECT_THAT(Take(20s), ElementsAre());
}

TEST_F(StateRepairTest, WhatIsStillLackingIsAskedForAgainEachTimeAfterTwiceAsLong)
{
    Announce("uav1");
    Tell("uav1", {1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 !"));
    Ns now = 10s;
    Ns wait = 2 * StateRepair::AskAfter;
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_EQ(repair.Due(), now + wait);
        Tell("uav1", {1s}, now + 1ms);
        EXPECT_EQ(repair.Due(), now + wait) << "beats change nothing";
        EXPECT_THAT(Take(now + wait - 1ns), ElementsAre());
        now += wait;
        EXPECT_THAT(Take(now), ElementsAre("uav1: 0 !"));
        wait = std::min(2 * wait, StateRepair::LongestWait);
    }
    EXPECT_EQ(wait, StateRepair::LongestWait);
}

TEST_F(StateRepairTest, AnAnswerIsGivenARoundTrip)
{
    Announce("uav1");
    Tell("uav1", {1s}, 10s, 1, 600ms);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 !"));
    EXPECT_EQ(repair.Due(), 10s + 600ms + StateRepair::AskAfter);
}

TEST_F(StateRepairTest, ALackAfterAnotherOneIsGivenTimeAnew)
{
    Announce("uav1");
    Have("uav1", 12, 1s);
    Tell("uav1", {1s, 1s, 1s}, 10s);
    for (Ns now = 10s; now < 20s; now += 100ms)
    {
        Take(now);
    }
    Have("uav1", 10, 1s);
    EXPECT_THAT(Take(20s), ElementsAre("uav1:"));
    Tell("uav1", {20s, 1s, 1s}, 20100ms);
    EXPECT_EQ(repair.Due(), 20100ms + StateRepair::AskAfter);
    EXPECT_THAT(Take(20200ms), ElementsAre("uav1: 0 !"));
    EXPECT_EQ(repair.Due(), 20200ms + 2 * StateRepair::AskAfter);
}

TEST_F(StateRepairTest, NodesAskAtRandomIfManyMayLackTheSame)
{
    Settled("uav1");
    random = 7'000'000;
    Tell("uav1", {3s, 1s, 1s}, 3s, 1, 0ns, 4);
    EXPECT_EQ(repair.Due(), 3s + StateRepair::AskAfter + 7ms);
    Settled("uav2");
    // This value gives the largest delay for a range of 100 ms; for a longer range it would give less.
    random = 2 * static_cast<std::uint64_t>(Ns(StateRepair::LongestSpread).count()) + 1;
    Tell("uav2", {3s, 1s, 1s}, 3s, 1, 0ns, 100'000);
    EXPECT_THAT(Take(3s + StateRepair::AskAfter + StateRepair::LongestSpread - 1ns),
                ElementsAre("uav1: 0 !"));
    EXPECT_THAT(Take(3s + StateRepair::AskAfter + StateRepair::LongestSpread), ElementsAre("uav2: 0 !"));
    Settled("uav3");
    random = 2'000'001;
    Tell("uav3", {3s, 1s, 1s}, 3s, 1, 0ns, 1);
    EXPECT_EQ(repair.Due(), 3s + StateRepair::AskAfter) << "with one other at most 2 ms";
}

TEST_F(StateRepairTest, ANodeThatIsLostIsNotAskedUntilItTellsAgain)
{
    Announce("uav1");
    Tell("uav1", {1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 !"));
    repair.Rest("uav1");
    EXPECT_FALSE(repair.Due());
    EXPECT_THAT(Take(11s), ElementsAre("uav1:"));
    EXPECT_THAT(Take(100s), ElementsAre());
    Tell("uav1", {1s}, 100s);
    EXPECT_THAT(Take(100s + StateRepair::AskAfter), ElementsAre("uav1: 0 !"));
}

TEST_F(StateRepairTest, WhatWasTakenInOfAFormerLifeDoesNotCount)
{
    Settled("uav1");
    Announce("uav1", 2);
    Tell("uav1", {1s, 1s, 1s}, 10s);
    EXPECT_FALSE(repair.Due()) << "a straggler of the former life";
    Tell("uav1", {1s, 1s, 1s}, 10s, 2);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 2 !"));
    Have("uav1", 10, 1s, 2);
    Have("uav1", 12, 1s, 2);
    EXPECT_THAT(Take(10s), ElementsAre("uav1:"));
}

TEST_F(StateRepairTest, WhatIsNoLongerWantedIsNoLongerAsked)
{
    Announce("uav1");
    Tell("uav1", {1s, 1s, 1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 2 !"));
    repair.SetWanted("uav1", 1, {});
    EXPECT_THAT(Take(11s), ElementsAre("uav1:"));
    EXPECT_FALSE(repair.Due());
    Announce("uav2");
    Tell("uav2", {1s, 1s, 1s}, 12s);
    EXPECT_THAT(Take(12s), ElementsAre("uav2: 0 2 !"));
    repair.SetWanted("uav2", 1, {{.State = 2, .Subscription = 12}});
    EXPECT_THAT(Take(13s), ElementsAre("uav2:"));
    Tell("uav2", {1s, 1s, 1s}, 13s);
    EXPECT_THAT(Take(13s), ElementsAre("uav2: 2 !"));
}

TEST_F(StateRepairTest, AStateThatTwoSubscriptionsWantIsAskedForUntilBothHaveIt)
{
    repair.SetWanted("uav1", 1, {{.State = 0, .Subscription = 1}, {.State = 0, .Subscription = 2}});
    Tell("uav1", {1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("uav1: 0 !"));
    Have("uav1", 1, 1s);
    EXPECT_THAT(Take(10s + 1ms), ElementsAre("uav1: 0")) << "one needs it still";
    Have("uav1", 2, 1s);
    EXPECT_THAT(Take(10s + 2ms), ElementsAre("uav1:"));
}

TEST_F(StateRepairTest, AForgottenNodeIsNotAsked)
{
    Announce("uav1");
    Tell("uav1", {1s}, 10s);
    repair.Forget("uav1");
    EXPECT_FALSE(repair.Due());
    EXPECT_THAT(Take(20s), ElementsAre());
    Tell("uav1", {1s}, 20s);
    EXPECT_FALSE(repair.Due());
}

TEST_F(StateRepairTest, NodesBeyondTheMostAreNotAskedAndThoseBeforeAre)
{
    for (std::size_t i = 0; i < StateRepair::MostNodes + 5; ++i)
    {
        const std::string node = std::string("uav").append(std::to_string(i));
        Announce(node);
        Tell(node, {1s}, 10s);
    }
    EXPECT_EQ(Take(10s).size(), StateRepair::MostNodes);
    repair.Forget("uav0");
    Announce("late");
    Tell("late", {1s}, 10s);
    EXPECT_THAT(Take(10s), ElementsAre("late: 0 !"));
}

}  // namespace
}  // namespace Rabit
