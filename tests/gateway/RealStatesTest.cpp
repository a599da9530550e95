// States that are sent once, over each pair of real backends, on loopback.
#include <gtest/gtest.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../Eventually.h"
#include "BackendPairs.h"
#include "DomainLease.h"
#include "gateway.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

constexpr std::size_t States = 5;

std::string NameOf(std::size_t state)
{
    return std::string("S").append(std::to_string(state));
}

// A node with a thread, whose contents the test may read whenever its gateway reports.
class Node
{
public:
    Node(const std::string &transport, const std::string &name, bool publishes) : _reactor(_workspace)
    {
        GatewayConfig config;
        config.Node = name;
        config.Domain = Conformance::OwnDomain();
        config.Interfaces = {"127.0.0.1"};
        for (std::size_t i = 0; i < States; ++i)
        {
            if (publishes)
            {
                config.Publish.push_back({.Message = NameOf(i), .Type = "Uav::MissionState"});
                _states.push_back(std::make_shared<Uav::MissionState>());
                _workspace.AddPublishSubscribeMessage(NameOf(i), _states.back());
            }
            else
            {
                config.Subscribe.push_back({.Message = NameOf(i), .Type = "Uav::MissionState"});
            }
        }
        auto looker = std::make_unique<Looker>(_workspace);
        _looker = looker.get();
        _reactor.SetHandleSignals(false);
        _reactor.AddManager(std::move(looker));
        _reactor.AddManager(std::make_unique<GatewayManager>(config, MakeTransport(transport), _workspace));
        _thread = std::thread([this] { _reactor.Run(); });
    }

    ~Node()
    {
        _reactor.ShutdownAllManagers();
        _thread.join();
    }

    void Post(std::uint32_t value)
    {
        for (const auto &state : _states)
        {
            state->commands = value;
            state->PostMessage();
        }
    }

    // Waits until the node shows this value of all States of the origin.
    bool Shows(const std::string &origin, std::uint32_t value)
    {
        return _looker->Wait(
            [&]
            {
                for (std::size_t i = 0; i < States; ++i)
                {
                    Uav::MissionState shown;
                    _workspace.ForceFetchMessage(origin + "/" + NameOf(i), &shown);
                    if (shown.commands != value)
                    {
                        return false;
                    }
                }
                return true;
            });
    }

    // Returns the samples of States written, by the gateway's report after this many from now.
    std::uint64_t WrittenAfter(int reports)
    {
        std::uint64_t written = 0;
        double last = -1;
        EXPECT_TRUE(_looker->Wait(
            [&]
            {
                Gateway::Fleet fleet;
                _workspace.ForceFetchMessage(FleetMessageName, &fleet);
                if (fleet.GetTimeStamp() != last)
                {
                    last = fleet.GetTimeStamp();
                    --reports;
                }
                written = 0;
                for (const Gateway::PublicationStatus &publication : fleet.publications)
                {
                    written += publication.written;
                }
                return reports < 0;
            }));
        return written;
    }

private:
    // Checks every few milliseconds whether the awaited condition holds.
    class Looker : public RabitManager
    {
    public:
        explicit Looker(RabitWorkspace &workspace) : RabitManager("Looker", workspace)
        {
            SetWakeupTimeDelayMSec(5);
        }

        void ExecuteUnitOfWork() final
        {
            const std::lock_guard lock(_mutex);
            _isSo = _isSo || (_holds && _holds());
            _looked.notify_all();
        }

        bool Wait(std::function<bool()> holds)
        {
            std::unique_lock lock(_mutex);
            _isSo = false;
            _holds = std::move(holds);
            const bool isSo = _looked.wait_for(lock, RabitTest::Hangs, [this] { return _isSo; });
            _holds = nullptr;
            return isSo;
        }

    private:
        std::mutex _mutex;
        std::condition_variable _looked;
        std::function<bool()> _holds;
        bool _isSo = false;
    };

    RabitWorkspace _workspace;
    RabitReactor _reactor;
    std::vector<std::shared_ptr<Uav::MissionState>> _states;
    Looker *_looker = nullptr;
    std::thread _thread;
};

// The backends of the publisher and of the nodes that want its States.
class RealStatesTest : public ::testing::TestWithParam<std::pair<std::string, std::string>>
{
};

TEST_P(RealStatesTest, ALateJoinerAndOneThatComesBackHaveAllStatesAndThenNothingIsSaid)
{
    Node uav(GetParam().first, "uav1", true);
    uav.Post(1);
    {
        Node ground(GetParam().second, "ground", false);
        EXPECT_TRUE(ground.Shows("uav1", 1));
        uav.Post(2);
        EXPECT_TRUE(ground.Shows("uav1", 2));
    }
    Node ground(GetParam().second, "ground", false);
    EXPECT_TRUE(ground.Shows("uav1", 2));
    // By then, all earlier requests are answered.
    const std::uint64_t written = uav.WrittenAfter(4);
    EXPECT_EQ(uav.WrittenAfter(4), written) << "what came is known by its version, as rounded on the way";
    EXPECT_TRUE(ground.Shows("uav1", 2));
}

TEST_P(RealStatesTest, OfANodeThatComesBackTheStatesOfItsNewLifeAreShown)
{
    Node ground(GetParam().second, "ground", false);
    {
        Node uav(GetParam().first, "uav1", true);
        uav.Post(1);
        EXPECT_TRUE(ground.Shows("uav1", 1));
    }
    Node uav(GetParam().first, "uav1", true);
    uav.Post(2);
    EXPECT_TRUE(ground.Shows("uav1", 2));
}

INSTANTIATE_TEST_SUITE_P(Backends, RealStatesTest, ::testing::ValuesIn(AllBackendPairs()), NameOfPair);

}  // namespace
}  // namespace Rabit
