// Times of whole nodes on networks that lose packets or are cut, under simulated time. The same faults with
// real programs, judged by outcomes alone: tests/integration/scenarios.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "WatchedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Duration = std::chrono::nanoseconds;

// From now on the ground station and the aircraft send each other so many notes a second.
void Exchange(WatchedFleet &fleet, const std::string &uav, int perSecond)
{
    fleet.Send("ground", uav, perSecond);
    fleet.Send(uav, "ground", perSecond);
}

// uav1 is cut off, and uav2 is not.
struct Outage
{
    const char *Name;
    Duration Length;
    bool IsMute;           // nothing of uav1 arrives
    bool IsDeaf;           // nothing arrives at uav1
    bool IsForAll = true;  // false: between uav1 and the ground station alone
};

class OutageTimes : public ::testing::TestWithParam<Outage>
{
};

TEST_P(OutageTimes, AreThoseOfBeatsAndOfTheLeaseAndNobodyElseIsDisturbed)
{
    const Outage &outage = GetParam();
    WatchedFleet fleet({"ground", "uav1", "uav2"});
    fleet.StartAll();
    Exchange(fleet, "uav1", 10);
    Exchange(fleet, "uav2", 10);
    fleet.RunFor(4s);
    const Duration begin = fleet.Now();
    const std::string others = outage.IsForAll ? "*" : "ground";
    if (outage.IsMute)
    {
        fleet.Nodes.Network.SetFaults("uav1", others, {.Cut = true});
    }
    if (outage.IsDeaf)
    {
        fleet.Nodes.Network.SetFaults(others, "uav1", {.Cut = true});
    }
    const Duration sending = std::min<Duration>(outage.Length, 60s);  // the outboxes have room for 100 s
    fleet.RunFor(sending);
    Exchange(fleet, "uav1", 0);
    fleet.RunFor(outage.Length - sending);
    Exchange(fleet, "uav1", 10);
    const Duration end = fleet.Now();
    fleet.Nodes.Network.ClearFaults();
    fleet.RunFor(20s);
    Exchange(fleet, "uav1", 0);
    Exchange(fleet, "uav2", 0);
    fleet.RunFor(10s);

    const Duration recovery = outage.Length < GatewayConfig().Lease ? 5s : 15s;
    std::vector<std::string> seen = {"UP", "STALE", "LOST", "UP"};
    if (outage.Length < 3s)
    {
        seen.erase(seen.begin() + 2);
    }
    const std::array<std::pair<const char *, const char *>, 2> ends = {
        {{"ground", "uav1"}, {"uav1", "ground"}}};
    for (const auto &[node, other] : ends)
    {
        if (node == std::string("ground") ? outage.IsMute : outage.IsDeaf)
        {
            EXPECT_EQ(fleet.StatesSince(node, other), seen) << node;
            EXPECT_LE(fleet.Until(node, other, "STALE", begin), 2s) << node;
            EXPECT_LE(outage.Length < 3s ? Duration(0) : fleet.Until(node, other, "LOST", begin), 4s) << node;
            EXPECT_LE(fleet.Until(node, other, "UP", end), recovery) << node;
        }
        EXPECT_LE(WatchedFleet::FirstAfter(fleet.Of(node, other).Notes, end), recovery) << node;
    }
    for (const auto &[node, other] : {std::pair("ground", "uav2"), std::pair("uav2", "ground")})
    {
        EXPECT_THAT(fleet.StatesSince(node, other), ElementsAre("UP")) << node;
        EXPECT_LE(WatchedFleet::P99(fleet.Of(node, other).Notes, 2s), 200ms) << node;
        EXPECT_GE(fleet.Of(node, other).Poses.size(),
                  static_cast<std::size_t>((fleet.Now() - 3s) / WatchedFleet::PosePeriod))
            << node;
    }
    if (!outage.IsForAll)
    {
        EXPECT_THAT(fleet.StatesSince("uav1", "uav2"), ElementsAre("UP"));
        EXPECT_THAT(fleet.StatesSince("uav2", "uav1"), ElementsAre("UP"));
    }
    fleet.ExpectAllNotes();
}

INSTANTIATE_TEST_SUITE_P(Cuts, OutageTimes,
                         ::testing::Values(Outage{"BothWaysFor2s", 2s, true, true},
                                           Outage{"BothWaysFor10s", 10s, true, true},
                                           Outage{"BothWaysFor40s", 40s, true, true},
                                           Outage{"MuteFor10s", 10s, true, false},
                                           Outage{"DeafFor40s", 40s, false, true},
                                           Outage{"MuteToTheGroundFor60s", 60s, true, false, false},
                                           Outage{"MuteToTheGroundFor10min", 10min, true, false, false}),
                         [](const auto &cut) { return std::string(cut.param.Name); });

struct LossOfAll
{
    int Percent;
    Duration P99;
};

class TimesUnderLoss : public ::testing::TestWithParam<LossOfAll>
{
};

TEST_P(TimesUnderLoss, CommandsComeSoonAndPosesAsOftenAsTheNetworkLets)
{
    const std::vector<std::string> names = {"ground", "uav1", "uav2", "uav3"};
    const double loss = GetParam().Percent / 100.0;
    WatchedFleet fleet(names);
    fleet.StartAll();
    fleet.RunFor(4s);
    fleet.Nodes.Network.SetFaults("*", "*", {.Loss = loss});
    const Duration since = fleet.Now();
    for (const int perSecond : {20, 0})
    {
        fleet.RunFor(perSecond == 0 ? 40s : 0s);
        for (const char *uav : {"uav1", "uav2", "uav3"})
        {
            Exchange(fleet, uav, perSecond);
        }
    }
    const auto posted = static_cast<double>((fleet.Now() - since) / WatchedFleet::PosePeriod);
    const double spread = 4 * std::sqrt(loss * (1 - loss) / posted);
    for (const std::string &node : names)
    {
        for (const std::string &other : names)
        {
            if (node == other)
            {
                continue;
            }
            const auto &poses = fleet.Of(node, other).Poses;
            const auto came = static_cast<double>(std::count_if(
                poses.begin(), poses.end(), [since](const auto &pose) { return pose.At > since; }));
            EXPECT_NEAR(came / posted, 1 - loss, spread + 0.02) << node << " of " << other;
            EXPECT_LE(WatchedFleet::FirstAfter(poses, 0s), 3s) << node << " of " << other;
            EXPECT_LE(fleet.Until(node, other, "UP", 0s), 3s) << node << " of " << other;
            if (loss == 0)
            {
                EXPECT_THAT(fleet.StatesSince(node, other), ElementsAre("UP")) << node << " of " << other;
            }
        }
    }
    fleet.RunFor(20s);
    fleet.ExpectAllNotes();
    for (const std::string uav : {"uav1", "uav2", "uav3"})
    {
        EXPECT_LE(WatchedFleet::P99(fleet.Of("ground", uav).Notes, since), GetParam().P99) << uav;
        EXPECT_LE(WatchedFleet::P99(fleet.Of(uav, "ground").Notes, since), GetParam().P99) << uav;
        const Gateway::LinkStatus link = fleet["ground"].LinkTo(uav, "Notes");
        EXPECT_LE(link.resent, 3 * link.accepted) << uav;
    }
}

INSTANTIATE_TEST_SUITE_P(Shares, TimesUnderLoss,
                         ::testing::Values(LossOfAll{0, 20ms}, LossOfAll{5, 100ms}, LossOfAll{10, 150ms},
                                           LossOfAll{20, 300ms}, LossOfAll{40, 2s}),
                         [](const auto &loss)
                         { return std::to_string(loss.param.Percent).append("Percent"); });

class CrashLoopTimes : public ::testing::TestWithParam<int>
{
};

// Without a state folder the wall clock alone tells the lives of the node apart.
TEST_P(CrashLoopTimes, EachLifeIsSeenSoonWhateverTheLeaseAndNobodyElseIsDisturbed)
{
    const auto lease = [](GatewayConfig &config) { config.Lease = std::chrono::seconds(GetParam()); };
    WatchedFleet fleet({"ground", "uav1", "uav2"});
    fleet.StartAll(lease);
    Exchange(fleet, "uav1", 40);
    Exchange(fleet, "uav2", 40);
    fleet.RunFor(3s);
    Duration started{0};
    for (int round = 0; round < 10; ++round)
    {
        for (const Duration life : {300ms, 300ms, 700ms, 700ms, 700ms, 3500ms})
        {
            fleet.Kill("uav1");
            started = fleet.Now();
            fleet.Start("uav1", lease);
            fleet.RunFor(life);
            for (const char *node : {"ground", "uav2"})
            {
                EXPECT_THAT(fleet[node].Problems(), Not(HasSubstr("have this name")));
            }
            EXPECT_THAT(fleet["uav1"].Problems(), Not(HasSubstr("the name of this one")));
        }
        for (const char *node : {"ground", "uav2"})
        {
            EXPECT_LE(WatchedFleet::FirstAfter(fleet.Of(node, "uav1").Poses, started), 3s) << node;
            EXPECT_LE(WatchedFleet::FirstAfter(fleet.Of("uav1", node).Poses, started), 3s) << node;
        }
    }
    fleet.RunFor(4s - (fleet.Now() - started));
    const Duration settled = fleet.Now();
    for (const char *node : {"ground", "uav2"})
    {
        EXPECT_EQ(fleet[node].StateOf("uav1"), "UP") << node;
        EXPECT_EQ(fleet["uav1"].StateOf(node), "UP") << node;
    }
    fleet.RunFor(20s);
    for (const auto &[node, other] : {std::pair("ground", "uav1"), std::pair("uav2", "uav1"),
                                      std::pair("uav1", "ground"), std::pair("uav1", "uav2")})
    {
        EXPECT_LT(fleet.Of(node, other).States.back().first, settled) << node << " of " << other;
    }
    EXPECT_THAT(fleet.StatesSince("ground", "uav2"), ElementsAre("UP"));
    EXPECT_THAT(fleet.StatesSince("uav2", "ground"), ElementsAre("UP"));
}

INSTANTIATE_TEST_SUITE_P(Leases, CrashLoopTimes, ::testing::Values(30, 90),
                         [](const auto &lease) { return std::to_string(lease.param).append("s"); });

TEST(StepsOfAWallClock, ChangeNoAgeAndNoStateOfPresence)
{
    constexpr double Hour = 3600;
    const std::vector<std::string> names = {"ground", "uav1", "uav2"};
    const auto publish = [](GatewayConfig &config)
    {
        config.Publish.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
        config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
    };
    WatchedFleet fleet(names);
    std::map<std::string, std::shared_ptr<Uav::MissionState>> states;
    std::map<WatchedFleet::Pair, std::shared_ptr<Uav::MissionState>> shown;
    for (const std::string &name : names)
    {
        SimulatedNode &node = fleet.Start(name, publish);
        states[name] = node.Register<Uav::MissionState>("MissionState");
        for (const std::string &other : names)
        {
            shown[{name, other}] =
                node.Register<Uav::MissionState>(name == other ? "Unused" : other + "/MissionState");
        }
    }
    Exchange(fleet, "uav1", 5);
    fleet.RunFor(4s);
    for (const double step : {Hour, -Hour, 24 * Hour, -24 * Hour, 87600 * Hour, -87600 * Hour})
    {
        ManualClock &clock = *fleet["uav1"].Clock;
        clock.SetGpsTimeSeconds(clock.GpsTimeSeconds() + step);
        for (int post = 0; post < 7; ++post)
        {
            const Duration posted = fleet.Now();
            for (const auto &[name, state] : states)
            {
                ++state->commands;
                state->PostMessage();
            }
            fleet.RunFor(490ms);
            for (const auto &[pair, state] : shown)
            {
                if (pair.first != pair.second)
                {
                    EXPECT_TRUE(state->FetchMessage() && state->commands == states[pair.second]->commands);
                    const double age = std::chrono::duration<double>(fleet.Now() - posted).count();
                    EXPECT_NEAR(state->GetAgeSeconds(*fleet[pair.first].Clock), age, 0.25)
                        << pair.first << " of " << pair.second << " after a step of " << step << " s";
                }
            }
        }
    }
    for (const std::string &name : names)
    {
        for (const std::string &other : names)
        {
            EXPECT_THAT(fleet.StatesSince(name, other), Each("UP")) << name << " of " << other;
        }
    }
    Exchange(fleet, "uav1", 0);
    fleet.RunFor(2s);
    fleet.ExpectAllNotes();
}

}  // namespace
}  // namespace Rabit
