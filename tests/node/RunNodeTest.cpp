#include <rabit/RabitLog.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/node/RunNode.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "DomainLease.h"

namespace Rabit
{
namespace
{

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Ends the whole program in its first unit of work.
class OneShot : public RabitManager
{
public:
    explicit OneShot(int &passes) : RabitManager("OneShot"), _passes(passes) {}
    void ExecuteUnitOfWork() final
    {
        ++_passes;
        ShutdownAllManagers(true);
    }

private:
    int &_passes;
};

class RunNodeTest : public ::testing::Test
{
protected:
    RunNodeTest()
    {
        std::ofstream(_file) << "node: one\ninterfaces: [127.0.0.1]\ntransport: "
                             << AvailableTransports().front() << "\n";
        _program.ConfigFile = _file;
        _program.AddManagers = [this](RabitReactor &reactor, GatewayConfig &config)
        {
            _node = config.Node;
            _domain = config.Domain;
            reactor.AddManager(std::make_unique<OneShot>(_passes));
        };
    }
    ~RunNodeTest() override { std::filesystem::remove(_file); }

    int Run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), "program");
        std::vector<char *> argv;
        for (std::string &argument : arguments)
        {
            argv.push_back(argument.data());
        }
        ::testing::internal::CaptureStdout();
        ::testing::internal::CaptureStderr();
        const int code = RunNode(static_cast<int>(argv.size()), argv.data(), _program);
        _out = ::testing::internal::GetCapturedStdout();
        _err = ::testing::internal::GetCapturedStderr();
        return code;
    }

    const std::string _file =
        (std::filesystem::temp_directory_path() / ("run_node_test." + std::to_string(::getpid()) + ".yaml"))
            .string();
    NodeProgram _program;
    std::string _out;
    std::string _err;
    std::string _node;
    int _domain = -1;
    int _passes = 0;
};

TEST_F(RunNodeTest, RunsTheManagersAndTheGatewayAndReturnsZero)
{
    EXPECT_EQ(Run({"--domain", std::to_string(Conformance::OwnDomain())}), 0);
    EXPECT_GE(_passes, 1);
    EXPECT_THAT(_err, IsEmpty());
}

TEST_F(RunNodeTest, OptionsTakeThePlaceOfTheFile)
{
    EXPECT_EQ(Run({"--check", "--node", "two", "--domain", "5"}), 0);
    EXPECT_EQ(_node, "two");
    EXPECT_EQ(_domain, 5);
}

TEST_F(RunNodeTest, KeysThatAreNotThereAreOneLine)
{
    EXPECT_EQ(Run({"--check", "--keys", "/nowhere/keys"}), ExitBadInput);
    EXPECT_THAT(_err, HasSubstr("no folder of keys /nowhere/keys"));
    EXPECT_EQ(_err.find('\n'), _err.size() - 1);
    EXPECT_THAT(_node, IsEmpty());
}

TEST_F(RunNodeTest, ACheckMakesTheManagersAndRunsNothing)
{
    EXPECT_EQ(Run({"--check"}), 0);
    EXPECT_EQ(_node, "one");
    EXPECT_EQ(_passes, 0);
}

TEST_F(RunNodeTest, AParameterThatTheProgramDoesNotReadIsOneLineAndNothingRuns)
{
    std::ofstream(_file, std::ios::app) << "parameters:\n  spacing: 20\n";
    double spacing = 0;
    const auto addManagers = _program.AddManagers;
    _program.AddManagers = [&](RabitReactor &reactor, GatewayConfig &config)
    {
        config.Parameters.Read("spacing_m", spacing);
        addManagers(reactor, config);
    };
    EXPECT_EQ(Run({}), ExitBadInput);
    EXPECT_THAT(_err, HasSubstr(":5: unknown parameter `spacing`; did you mean `spacing_m`?\n"));
    EXPECT_EQ(_passes, 0);
}

TEST_F(RunNodeTest, LinesOfTheLogBeginWithTheNodesName)
{
    _program.AddManagers = [this](RabitReactor &reactor, GatewayConfig &)
    {
        RabitLog::Write(RabitLogLevel::Warning, "hello");
        reactor.AddManager(std::make_unique<OneShot>(_passes));
    };
    EXPECT_EQ(Run({"--check", "--node", "two"}), 0);
    EXPECT_EQ(_err, "two: warning: hello\n");
}

TEST_F(RunNodeTest, RecordsTheNodeIfTheConfigurationSaysSo)
{
    const auto folder =
        std::filesystem::path(::testing::TempDir()) / ("rabit_run_node_" + std::to_string(::getpid()));
    std::ofstream(_file, std::ios::app) << "record: {folder: " << folder.string() << ", free: 0B}\n";
    EXPECT_EQ(Run({"--domain", std::to_string(Conformance::OwnDomain())}), 0);
    std::string content;
    int files = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
    {
        std::ifstream stream(entry.path(), std::ios::binary);
        content.assign(std::istreambuf_iterator<char>(stream), {});
        ++files;
    }
    std::filesystem::remove_all(folder);
    EXPECT_EQ(files, 1);
    EXPECT_THAT(content, HasSubstr("record: {folder: ")) << "the configuration";
    EXPECT_TRUE(content.ends_with("MCAP0\r\n")) << "it was not ended in order";
}

TEST_F(RunNodeTest, AnOptionNamesTheFolderOfTheRecording)
{
    const auto folder =
        std::filesystem::path(::testing::TempDir()) / ("rabit_run_node_option_" + std::to_string(::getpid()));
    EXPECT_EQ(Run({"--record", folder.string(), "--domain", std::to_string(Conformance::OwnDomain())}), 0);
    EXPECT_TRUE(std::filesystem::exists(folder));
    std::filesystem::remove_all(folder);
}

TEST_F(RunNodeTest, OptionsNameTheInterfaces)
{
    const auto addManagers = _program.AddManagers;
    std::vector<std::string> interfaces;
    _program.AddManagers = [&](RabitReactor &reactor, GatewayConfig &config)
    {
        interfaces = config.Interfaces;
        addManagers(reactor, config);
    };
    EXPECT_EQ(Run({"--check", "--interface", "lo", "--interface", "127.0.0.2"}), 0);
    EXPECT_THAT(interfaces, ::testing::ElementsAre("lo", "127.0.0.2"));
}

TEST_F(RunNodeTest, TheEnvironmentNamesTheFolderOfTheKeys)
{
    ASSERT_EQ(::setenv("RABIT_NODE_KEYS", "/nowhere/keys", 1), 0);
    EXPECT_EQ(Run({"--check"}), ExitBadInput);
    EXPECT_THAT(_err, HasSubstr("/nowhere/keys"));
    ASSERT_EQ(::unsetenv("RABIT_NODE_KEYS"), 0);
    EXPECT_EQ(Run({"--check"}), 0);
}

TEST_F(RunNodeTest, NamesAPublishedMessageThatNoManagerRegisters)
{
    std::ofstream(_file, std::ios::app)
        << "publish:\n  - {message: OneShotStat, type: Rabit::Gateway::Fleet}\n";
    const auto registered = std::make_shared<Gateway::Fleet>();
    const auto addManagers = _program.AddManagers;
    _program.AddManagers = [&](RabitReactor &reactor, GatewayConfig &config)
    {
        RabitWorkspace::GetWorkspace()->AddPublishSubscribeMessage("OneShotState", registered);
        addManagers(reactor, config);
    };
    EXPECT_EQ(Run({"--check"}), 0);
    EXPECT_THAT(_err,
                HasSubstr("one: warning: publish OneShotStat: no manager has registered that message in "
                          "its constructor; did you mean `OneShotState`?\n"));
}

TEST_F(RunNodeTest, AWrongConfigurationIsOneLineAndNothingIsMade)
{
    std::ofstream(_file) << "node: one\ndomain: 233\n";
    EXPECT_EQ(Run({}), ExitBadInput);
    EXPECT_THAT(_err, HasSubstr(_file + ":2: "));
    EXPECT_EQ(_err.find('\n'), _err.size() - 1);
    EXPECT_THAT(_node, IsEmpty());
}

TEST_F(RunNodeTest, ATransportThatThisBuildHasNotIsOneLine)
{
    EXPECT_EQ(Run({"--transport", "pigeon"}), ExitBadInput);
    EXPECT_EQ(_err.find('\n'), _err.size() - 1);
}

TEST_F(RunNodeTest, WhatTheProgramFindsWrongInItsOwnFilesEndsInTheSameWay)
{
    _program.AddManagers = [](RabitReactor &, GatewayConfig &)
    { throw ConfigError("world.yaml", 3, "flat"); };
    EXPECT_EQ(Run({}), ExitBadInput);
    EXPECT_EQ(_err, "world.yaml:3: flat\n");
}

TEST_F(RunNodeTest, AnExceptionIsOneLineAndAFailure)
{
    _program.AddManagers = [](RabitReactor &, GatewayConfig &) { throw std::runtime_error("no camera"); };
    EXPECT_EQ(Run({}), ExitFailed);
    EXPECT_EQ(_err, "program: no camera\n");
    _program.AddManagers = [](RabitReactor &, GatewayConfig &) { throw 7; };
    EXPECT_EQ(Run({}), ExitFailed);
    EXPECT_EQ(_err, "program: ended by an exception of an unknown type\n");
}

TEST_F(RunNodeTest, OptionsOfTheProgramAreKnownWhenItsManagersAreMade)
{
    int rate = 0;
    int seen = 0;
    _program.AddOptions = [&rate](CLI::App &app) { app.add_option("--rate", rate, "Hz"); };
    _program.AddManagers = [&](RabitReactor &, GatewayConfig &) { seen = rate; };
    EXPECT_EQ(Run({"--check", "--rate", "7"}), 0);
    EXPECT_EQ(seen, 7);
    EXPECT_EQ(Run({"--help"}), 0);
    EXPECT_THAT(_out, HasSubstr("--rate"));
    EXPECT_THAT(_out, HasSubstr("--config"));
}

TEST_F(RunNodeTest, AnUnknownOptionIsRefused)
{
    EXPECT_EQ(Run({"--speed", "7"}), ExitBadInput);
    EXPECT_THAT(_err, HasSubstr("--speed"));
    EXPECT_EQ(_passes, 0);
}

}  // namespace
}  // namespace Rabit
