// Cells that are flown by one aircraft each, a leader, and a table that all share.
#include <gtest/gtest.h>
#include <rabit/RabitManager.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/SharedTable.h>
#include <rabit/node/RunNode.h>
#include <rabit/testing/SimulatedFleet.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace std::chrono_literals;

// [coverage]
// Flies one cell after the other: those that nobody has flown, and that nobody else has taken.
class Coverage : public Rabit::RabitManager
{
public:
    Coverage(Rabit::RabitWorkspace &workspace, Rabit::GatewayConfig &config)
        : RabitManager("Coverage", workspace), _claims(config), _table(config)
    {
        SetPeriodSec(0.1);
    }

    void ExecuteUnitOfWork() final
    {
        if (_isFlying && _claims.StillMine(_claim))
        {
            FlyOn();
        }
        else if (_claims.StillMine(_claim))
        {
            _isFlying = true;
            _passes = 0;
        }
        else if (!_claims.StatusOf(_claim).IsWanted)
        {
            Next();  // none yet, refused, or lost
        }
    }

    std::map<std::size_t, int> Flown;  // cells, and how often this aircraft has flown them

private:
    static constexpr std::size_t Cells = 6;
    static constexpr int PassesOfACell = 30;

    void FlyOn()
    {
        if (++_passes >= PassesOfACell)
        {
            ++Flown[_cell];
            // The claim is kept: the others have not heard of this yet.
            _table.Add("flown", _cell);
            Next();
        }
    }

    void Next()
    {
        _isFlying = false;
        _claim.clear();
        const std::set<std::size_t> flown = _table.Numbers("flown");
        for (std::size_t i = 1; i <= Cells; ++i)
        {
            const std::size_t cell = (_cell + i) % Cells;
            const std::string claim = "cell " + std::to_string(cell);
            if (!flown.contains(cell) && _claims.StatusOf(claim).Holder.empty())
            {
                _cell = cell;
                _claim = claim;
                _claims.Try(claim);
                return;
            }
        }
    }

    Rabit::Claims _claims;
    Rabit::SharedTable _table;
    std::size_t _cell = 0;
    std::string _claim;  // empty: none
    bool _isFlying = false;
    int _passes = 0;
};
// [/coverage]

// [main]
int CoverageMain(int argc, char **argv)
{
    Rabit::NodeProgram program;
    program.ConfigFile = "uav.yaml";  // with `agreement`
    program.AddManagers = [](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    { reactor.AddManager(std::make_unique<Coverage>(*Rabit::RabitWorkspace::GetWorkspace(), config)); };
    return Rabit::RunNode(argc, argv, program);
}
// [/main]

// [leader]
class Leader : public Rabit::RabitManager
{
public:
    Leader(Rabit::RabitWorkspace &workspace, Rabit::GatewayConfig &config)
        : RabitManager("Leader", workspace), _claims(config)
    {
        _claims.ConnectChanged(WakeUpHandler());
        _claims.BeLeader();  // or stand by
    }

    void ExecuteUnitOfWork() final
    {
        Leads = _claims.IsLeader();  // give orders
        Follows = _claims.Leader();  // show whom this one follows
    }

    bool Leads = false;
    std::string Follows;

private:
    Rabit::Claims _claims;
};
// [/leader]

Rabit::GatewayConfig AgreeingNode(const std::string &node)
{
    Rabit::GatewayConfig config;
    config.Node = node;
    config.Agreement.emplace().Members = {"uav1", "uav2", "ground"};
    return config;
}

// A node with one manager, which belongs to the fleet.
template <typename Manager>
Manager *AddAgreeing(Rabit::SimulatedFleet &fleet, const std::string &name)
{
    Manager *added = nullptr;
    fleet.Add(AgreeingNode(name),
              [&added](Rabit::SimulatedNode &node, Rabit::GatewayConfig &config)
              {
                  auto made = std::make_unique<Manager>(node.Workspace, config);
                  added = made.get();
                  node.Reactor.AddManager(std::move(made));
              });
    return added;
}

TEST(AgreementExample, EachCellIsFlownOnce)
{
    Rabit::SimulatedFleet fleet;
    const Coverage *const one = AddAgreeing<Coverage>(fleet, "uav1");
    const Coverage *const other = AddAgreeing<Coverage>(fleet, "uav2");
    fleet.Add(AgreeingNode("ground"));
    fleet.RunFor(60s);
    std::map<std::size_t, int> flown = one->Flown;
    for (const auto &[cell, times] : other->Flown)
    {
        flown[cell] += times;
    }
    EXPECT_EQ(flown, (std::map<std::size_t, int>{{0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}}));
    EXPECT_FALSE(one->Flown.empty());
    EXPECT_FALSE(other->Flown.empty());
}

TEST(AgreementExample, OneLeads)
{
    Rabit::SimulatedFleet fleet;
    const std::vector<const Leader *> managers = {AddAgreeing<Leader>(fleet, "uav1"),
                                                  AddAgreeing<Leader>(fleet, "uav2"),
                                                  AddAgreeing<Leader>(fleet, "ground")};
    fleet.RunFor(20s);
    int leaders = 0;
    for (const Leader *const manager : managers)
    {
        leaders += manager->Leads ? 1 : 0;
        EXPECT_EQ(manager->Follows, managers.front()->Follows);
    }
    EXPECT_EQ(leaders, 1);
    EXPECT_NE(managers.front()->Follows, "");
}

TEST(AgreementExample, AProgramWithoutTheSectionEndsWithALine)
{
    const std::string file = ::testing::TempDir() + "rabit-agree-" + std::to_string(::getpid()) + ".yaml";
    std::vector<std::string> words = {"uav", "--config", file, "--check"};
    std::vector<char *> arguments;
    for (std::string &word : words)
    {
        arguments.push_back(word.data());
    }
    const auto count = static_cast<int>(arguments.size());
    std::ofstream(file) << "node: uav1\ninterfaces: [lo]\n";
    EXPECT_EQ(CoverageMain(count, arguments.data()), Rabit::ExitBadInput);
    std::ofstream(file) << "node: uav1\ninterfaces: [lo]\nagreement: {members: [uav1]}\n";
    EXPECT_EQ(CoverageMain(count, arguments.data()), 0);
    std::filesystem::remove(file);
}

}  // namespace
