// Managers of a node that hang or throw: whole nodes on the simulated network.
#include <gmock/gmock.h>

#include <functional>
#include <future>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../core/CapturedLog.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class WorkingManager : public RabitManager
{
public:
    using RabitManager::RabitManager;
    void ExecuteUnitOfWork() final { OnWork(); }
    std::function<void()> OnWork = [] {};
};

class TroubledManagersOfANode : public ::testing::Test
{
protected:
    TroubledManagersOfANode() : uav(fleet.Add(Named("uav1"))), ground(fleet.Add(Named("ground")))
    {
        fleet.RunFor(5s);
    }

    // Wants nothing but the problems of the aircraft.
    static GatewayConfig Named(const std::string &node)
    {
        GatewayConfig config;
        config.Node = node;
        config.ProblemsOf = {"uav*"};
        return config;
    }

    static std::vector<std::string> RowsOf(SimulatedNode &node)
    {
        std::vector<std::string> rows;
        for (const Gateway::Problem &problem : node.Fleet().problems)
        {
            rows.push_back(problem.subject + ": " + problem.reason);
        }
        return rows;
    }

    RabitTest::CapturedLog log;
    SimulatedFleet fleet{1};
    SimulatedNode &uav;
    SimulatedNode &ground;
};

TEST_F(TroubledManagersOfANode, AManagerThatHangsIsAProblemUntilItGoesOn)
{
    const std::string row =
        "manager Vision: its unit of work has not returned for more than 1.0 s; its "
        "wake-ups, its queue and a shutdown wait for it";
    WorkingManager vision("Vision", uav.Workspace);
    std::promise<void> entered;
    std::promise<void> release;
    bool hung = false;
    vision.OnWork = [&]
    {
        if (!std::exchange(hung, true))
        {
            entered.set_value();
            release.get_future().wait();
        }
    };
    vision.Run();
    entered.get_future().wait();
    fleet.RunFor(500ms);
    EXPECT_THAT(RowsOf(uav), IsEmpty());
    fleet.RunFor(2s);
    EXPECT_THAT(RowsOf(uav), ElementsAre(row));
    EXPECT_THAT(log.Lines(), Not(Contains(HasSubstr("gateway: manager Vision"))))
        << "it may be late for once";
    fleet.RunFor(2s);
    EXPECT_THAT(log.Lines(),
                Contains(HasSubstr("uav1: gateway: manager Vision: its unit of work has not returned")));
    fleet.RunFor(13s);
    EXPECT_THAT(RowsOf(uav), ElementsAre(HasSubstr("for more than 10.0 s")));
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
    const Gateway::Fleet seen = ground.Fleet();
    ASSERT_EQ(seen.nodes.size(), 1u);
    EXPECT_THAT(seen.nodes[0].problem_texts, ElementsAre(HasSubstr("manager Vision: its unit of work")));
    release.set_value();
    vision.ShutdownManager();
    vision.Join();
    fleet.RunFor(2s);
    EXPECT_THAT(RowsOf(uav), IsEmpty());
}

TEST_F(TroubledManagersOfANode, AManagerThatThrowsAtEachTurnIsAProblemUntilATurnSucceeds)
{
    auto added = std::make_unique<WorkingManager>("Sensor", uav.Workspace);
    bool fails = true;
    added->OnWork = [&fails]
    {
        if (fails)
        {
            throw std::runtime_error("no fix");
        }
    };
    uav.Reactor.AddManager(std::move(added));
    fleet.RunFor(4s);
    EXPECT_THAT(RowsOf(uav), ElementsAre("manager Sensor: its unit of work threw: no fix"));
    EXPECT_THAT(log.Lines(), Contains("uav1: gateway: manager Sensor: its unit of work threw: no fix"));
    fails = false;
    fleet.RunFor(3s);
    EXPECT_THAT(RowsOf(uav), IsEmpty());
}

TEST_F(TroubledManagersOfANode, AFailureThatIsOverSoonIsNotLogged)
{
    auto added = std::make_unique<WorkingManager>("Sensor", uav.Workspace);
    bool failed = false;
    added->OnWork = [&failed]
    {
        if (!std::exchange(failed, true))
        {
            throw std::runtime_error("no fix");
        }
    };
    uav.Reactor.AddManager(std::move(added));
    fleet.RunFor(10s);
    EXPECT_THAT(log.Lines(), Not(Contains(HasSubstr("gateway: manager Sensor"))));
}

}  // namespace
}  // namespace Rabit
