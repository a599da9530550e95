// Five aircraft with the real configuration file cover an area, on a simulated network that loses and cuts.
#include "Sweep.h"

#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/testing/SimulatedFleet.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace Paths
{
extern const char *const CoverageFolder;
}

namespace
{
using namespace std::chrono_literals;

class CoverageFleet : public testing::Test
{
protected:
    void SetUp() override
    {
        for (const char *const name : {"uav1", "uav2", "uav3", "uav4", "uav5"})
        {
            Start(name);
        }
    }
    void Start(const std::string &name)
    {
        _fleet.Add(
            Rabit::LoadGatewayConfig(std::string(Paths::CoverageFolder) + "/coverage.yaml", name), 1.4e9, "",
            [this](Rabit::SimulatedNode &node, Rabit::GatewayConfig &config)
            {
                auto sweep = std::make_unique<Coverage::Sweep>(Coverage::Settings(), config, node.Workspace);
                _sweeps[config.Node] = sweep.get();
                node.Reactor.AddManager(std::move(sweep));
            });
    }
    void Kill(const std::string &name)
    {
        _sweeps.erase(name);
        _fleet.Kill(name);
    }

    // The oracle: it knows over which cell each aircraft is.
    void Fly(std::chrono::milliseconds duration)
    {
        for (auto flown = 0ms; flown < duration; flown += 50ms)
        {
            _fleet.RunFor(50ms);
            std::map<std::size_t, std::string> over;
            for (const auto &[name, sweep] : _sweeps)
            {
                if (const std::optional<std::size_t> cell = sweep->Over())
                {
                    const auto [first, isAlone] = over.emplace(*cell, name);
                    ASSERT_TRUE(isAlone) << name << " and " << first->second << " over cell " << *cell;
                }
            }
        }
    }
    bool AreAllHomeWithin(std::chrono::seconds limit)
    {
        for (auto flown = 0s; flown < limit && !AreAllHome(); flown += 1s)
        {
            Fly(1s);
        }
        return AreAllHome();
    }
    bool AreAllHome() const
    {
        bool all = true;
        for (const auto &[name, sweep] : _sweeps)
        {
            all = all && sweep->IsHome();
        }
        return all;
    }
    void ExpectAllFlown() const
    {
        for (const auto &[name, sweep] : _sweeps)
        {
            EXPECT_EQ(sweep->Flown().size(), 24u) << name;
        }
    }

    Rabit::SimulatedFleet _fleet{5};
    std::map<std::string, Coverage::Sweep *> _sweeps;
};

TEST_F(CoverageFleet, FliesAllCellsEachByOneAircraft)
{
    EXPECT_TRUE(AreAllHomeWithin(90s));  // 24 cells of 6 s, five aircraft: 30 s of flight
    ExpectAllFlown();
}

TEST_F(CoverageFleet, FliesAllCellsThoughAnAircraftDiesAnotherIsCutOffAndAFifthIsLost)
{
    _fleet.Network.SetFaults("*", "*", {.Loss = 0.2});
    Fly(15s);
    Kill("uav1");
    Fly(5s);
    _fleet.Network.SetFaults("uav3", "*", {.Cut = true});
    _fleet.Network.SetFaults("*", "uav3", {.Cut = true});
    Fly(3s);
    EXPECT_FALSE(_sweeps["uav3"]->Over()) << "its lease has ended";
    Fly(42s);
    _fleet.Network.SetFaults("uav3", "*", {.Loss = 0.2});
    _fleet.Network.SetFaults("*", "uav3", {.Loss = 0.2});
    EXPECT_TRUE(AreAllHomeWithin(180s));
    ExpectAllFlown();
}

TEST_F(CoverageFleet, ARestartedAircraftJoinsAgain)
{
    Fly(12s);
    Kill("uav2");
    Fly(1s);
    Start("uav2");
    EXPECT_TRUE(AreAllHomeWithin(120s));
    ExpectAllFlown();
}

}  // namespace
