// The main() of a node, and what its managers know of the fleet.
#include <gtest/gtest.h>
#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetValues.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/gateway/NodeParameters.h>
#include <rabit/node/NodeOptions.h>
#include <rabit/node/RunNode.h>
#include <rabit/node/RunProgram.h>
#include <rabit/node/TcpServer.h>
#include <rabit/testing/SimulatedFleet.h>

#include <CLI/CLI.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [values]
class Formation : public Rabit::RabitManager
{
public:
    Formation(Rabit::RabitWorkspace &workspace, double spacing)
        : RabitManager("Formation", workspace), Spacing(spacing)
    {
        SetPeriodSec(0.2);
    }

    void ExecuteUnitOfWork() final
    {
        _poses.Fetch();
        Near = 0;
        for (const auto &[node, pose] : _poses.YoungerThan(0.5))  // seconds
        {
            Near += pose->altitude_m > 0 ? 1 : 0;
        }
    }

    double Spacing;
    int Near = 0;

private:
    Rabit::FleetValues<Uav::Pose> _poses{*this, "Pose"};  // uav1/Pose, uav2/Pose, ...
};
// [/values]

// [fleet]
class Watch : public Rabit::RabitManager
{
public:
    explicit Watch(Rabit::RabitWorkspace &workspace) : RabitManager("Watch", workspace)
    {
        AddPublishSubscribeMessage("Gateway/Fleet", _fleet);
        WakeUpManagerOnMessagePost(_fleet);
    }

    void ExecuteUnitOfWork() final
    {
        if (_fleet->FetchMessage())
        {
            const Rabit::Gateway::NodeStatus *ground = Rabit::Gateway::FindNode(*_fleet, "ground");
            IsAlone = ground == nullptr || ground->state == Rabit::Gateway::NodeState::LOST;
            for (const Rabit::Gateway::Problem &problem : _fleet->problems)
            {
                LastProblem = problem.subject + ": " + problem.reason;
            }
        }
    }

    bool IsAlone = false;
    std::string LastProblem;

private:
    const std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
};
// [/fleet]

// [main]
int Main(int argc, char **argv)
{
    bool isQuiet = false;
    Rabit::NodeProgram program;
    program.ConfigFile = "uav.yaml";
    program.Description = "Flies in formation.";
    program.AddOptions = [&isQuiet](CLI::App &app) { app.add_flag("--quiet", isQuiet, "Print nothing"); };
    program.AddManagers = [](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    {
        double spacing = 15;                                   // the default
        config.Parameters.Read("spacing_m", spacing, 5, 200);  // must be from 5 to 200
        reactor.AddManager(std::make_unique<Formation>(*Rabit::RabitWorkspace::GetWorkspace(), spacing));
    };
    return Rabit::RunNode(argc, argv, program);
}
// [/main]

class NodeExample : public ::testing::Test
{
protected:
    ~NodeExample() override { std::filesystem::remove(_file); }

    int RunWith(const std::string &yaml)
    {
        std::ofstream(_file) << yaml;
        std::vector<std::string> words = {"uav", "--config", _file, "--check"};
        std::vector<char *> arguments;
        for (std::string &word : words)
        {
            arguments.push_back(word.data());
        }
        return Main(static_cast<int>(arguments.size()), arguments.data());
    }

    const std::string _file = ::testing::TempDir() + "rabit-node-" + std::to_string(::getpid()) + ".yaml";
};

TEST_F(NodeExample, AParameterOutOfItsRangeIsAnErrorOfTheFile)
{
    EXPECT_EQ(RunWith("node: uav1\ninterfaces: [lo]\nparameters: {spacing_m: 20}\n"), 0);
    EXPECT_EQ(RunWith("node: uav1\ninterfaces: [lo]\nparameters: {spacing_m: 500}\n"), Rabit::ExitBadInput);
}

// [options]
TEST_F(NodeExample, AProgramOfItsOwnKindTakesTheOptionsOfANode)
{
    std::ofstream(_file) << "node: uav1\n";
    CLI::App app;
    Rabit::NodeOptions options;
    Rabit::AddNodeOptions(app, options);
    const std::vector<const char *> words = {"uav", "--config", _file.c_str(), "--node", "uav2"};
    const int code =
        Rabit::RunProgram(app, static_cast<int>(words.size()), const_cast<char **>(words.data()),
                          [&options] { return Rabit::LoadNodeConfig(options).Node == "uav2" ? 0 : 1; });
    EXPECT_EQ(code, 0);
}
// [/options]

// [parameters]
TEST_F(NodeExample, ValuesOfTheProgramStandInTheConfiguration)
{
    std::ofstream(_file) << "node: uav1\nparameters: {leader: uav2, patience: 2s}\n";
    const Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(_file);
    const Rabit::NodeParameters &parameters = config.Parameters;
    std::string leader = "uav1";
    std::chrono::milliseconds patience{500};
    parameters.Read("leader", leader);
    parameters.Read("patience", patience);
    parameters.RefuseOthers();  // RunNode does that
    EXPECT_EQ(leader, "uav2");
    EXPECT_EQ(patience, 2s);
}
// [/parameters]

TEST(NodeFleetExample, AManagerSeesTheOthersAndTheirValues)
{
    Rabit::SimulatedFleet fleet;
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose", .Qos = Rabit::QosProfile::Telemetry});
    std::shared_ptr<Uav::Pose> pose;
    fleet.Add(config, [&pose](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
              { pose = node.Register<Uav::Pose>("Pose"); });
    config = {};
    config.Node = "uav2";
    config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"});
    Watch *watch = nullptr;
    Formation *formation = nullptr;
    fleet.Add(config,
              [&watch, &formation](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
              {
                  auto made = std::make_unique<Watch>(node.Workspace);
                  watch = made.get();
                  node.Reactor.AddManager(std::move(made));
                  auto other = std::make_unique<Formation>(node.Workspace, 15);
                  formation = other.get();
                  node.Reactor.AddManager(std::move(other));
              });
    fleet.RunFor(5s);
    for (int number = 1; number <= 20; ++number)
    {
        pose->altitude_m = 50;
        pose->PostMessage();
        fleet.RunFor(100ms);
    }
    EXPECT_EQ(formation->Near, 1);
    EXPECT_TRUE(watch->IsAlone);  // there is no ground
}

// [server]
TEST(ServerExample, AServerGreetsEachConnection)
{
    using boost::asio::ip::tcp;
    Rabit::TcpServer server(tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
    server.Start("greeter", [](tcp::socket socket)
                 { boost::asio::write(socket, boost::asio::buffer(std::string("hello\n"))); });

    boost::asio::io_context io;
    tcp::socket viewer(io);
    viewer.connect(server.Address());
    std::string line;
    boost::system::error_code end;
    boost::asio::read(viewer, boost::asio::dynamic_buffer(line), end);
    EXPECT_EQ(line, "hello\n");
}
// [/server]

}  // namespace
