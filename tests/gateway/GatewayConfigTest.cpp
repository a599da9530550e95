#include <gtest/gtest.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class GatewayConfigTest : public ::testing::Test
{
protected:
    GatewayConfigTest()
    {
        const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
        _folder = std::filesystem::path(::testing::TempDir()) /
                  ("rabit-config-" + std::to_string(std::hash<std::string>{}(test->name())) + "-" +
                   std::to_string(::getpid()));
        std::filesystem::create_directories(_folder);
    }

    ~GatewayConfigTest() override
    {
        std::error_code ignored;
        std::filesystem::remove_all(_folder, ignored);
    }

    GatewayConfig Load(const std::string &yaml, const std::string &node = "") const
    {
        const std::string file = (_folder / "node.yaml").string();
        std::ofstream(file) << yaml;
        return LoadGatewayConfig(file, node);
    }

    // Returns the error without the folder.
    std::string ErrorOf(const std::string &yaml, const std::string &node = "") const
    {
        try
        {
            Load(yaml, node);
        }
        catch (const ConfigError &error)
        {
            const std::string text = error.what();
            const std::string prefix = _folder.string() + "/";
            EXPECT_EQ(text.rfind(prefix, 0), 0u) << text;
            return text.substr(prefix.size());
        }
        return "no error";
    }

    std::filesystem::path _folder;
};

TEST_F(GatewayConfigTest, TakesTypesThatOnlySomebodyElseKnowsAsThatOneSays)
{
    const std::string file = (_folder / "node.yaml").string();
    std::ofstream(file) << "node: a\npublish:\n  - {message: Pose, type: My::Pose}\n"
                           "accept:\n  - {queue: Q, types: [My::Command]}\n";
    const GatewayConfig config =
        LoadGatewayConfig(file, "b", [](const std::string &) { return std::string(); });
    EXPECT_EQ(config.Node, "b");
    EXPECT_EQ(config.Publish.at(0).Type, "My::Pose");
    EXPECT_EQ(config.Accept.at(0).Types.at(0), "My::Command");
    try
    {
        LoadGatewayConfig(file, "b",
                          [](const std::string &type)
                          { return type == "My::Pose" ? "" : "no type `" + type + "`"; });
        FAIL() << "it was taken";
    }
    catch (const ConfigError &error)
    {
        EXPECT_EQ(error.what(), file + ":5: no type `My::Command`");
    }
}

TEST_F(GatewayConfigTest, ALeadingScopeOfATypeIsLeftOut)
{
    const GatewayConfig config = ParseGatewayConfig(
        "node: a\npublish:\n  - {message: Pose, type: ::My::Pose}\n"
        "subscribe:\n  - {message: Pose, type: '::My::Pose'}\n"
        "accept:\n  - {queue: Q, types: [::My::Go, My::Stop]}\n"
        "foreign:\n  - {subscribe: clock, as: Clock, type: ::My::Clock}\n",
        "node.yaml", "", [](const std::string &) { return std::string(); });
    EXPECT_EQ(config.Publish.at(0).Type, "My::Pose");
    EXPECT_EQ(config.Subscribe.at(0).Type, "My::Pose");
    EXPECT_EQ(config.Accept.at(0).Types, (std::vector<std::string>{"My::Go", "My::Stop"}));
    EXPECT_EQ(config.Foreign.at(0).Type, "My::Clock");
}

TEST_F(GatewayConfigTest, AByteOrderMarkAtTheBeginningIsNoPartOfTheText)
{
    EXPECT_EQ(Load("\xEF\xBB\xBFnode: a\ndomain: 7\n").Domain, 7);
    EXPECT_EQ(ErrorOf("\xEF\xBB\xBF---\n---\nnode: a\n"),
              "node.yaml:2: a second document: a configuration is one");
}

TEST_F(GatewayConfigTest, ReadsWhatIsRecorded)
{
    EXPECT_FALSE(Load("node: a\n").Record);
    const RecordSettings least = *Load("node: a\nrecord: {folder: /var/lib/rabit/recordings}\n").Record;
    EXPECT_EQ(least.Folder, "/var/lib/rabit/recordings");
    EXPECT_EQ(least.Messages, std::vector<std::string>{"*"});
    const RecordSettings all = *Load(R"(
node: a
record:
  folder: x
  messages: [Pose, "uav*/Pose"]
  except: "*/CameraView"
  queues: off
  steps: [MissionControl, "Health*"]
  split_size: 256MB
  split_time: 2min
  keep: 1.5GB
  free: 0B
  memory: 10MB
)")
                                    .Record;
    EXPECT_EQ(all.Messages, (std::vector<std::string>{"Pose", "uav*/Pose"}));
    EXPECT_EQ(all.Except, std::vector<std::string>{"*/CameraView"});
    EXPECT_FALSE(all.Queues);
    EXPECT_EQ(all.Steps, (std::vector<std::string>{"MissionControl", "Health*"}));
    EXPECT_EQ(all.SplitSize, 256000000U);
    EXPECT_EQ(all.SplitTime, 120s);
    EXPECT_EQ(all.Keep, 1500000000U);
    EXPECT_EQ(all.Free, 0U);
    EXPECT_EQ(all.Memory, 10000000U);
    EXPECT_FALSE(all.BlackBox);
    const BlackBoxSettings box = *Load(R"(
node: a
record:
  folder: x
  black_box: {before: 2min, after: 5s, messages: [Alarm], queues: MissionControl, outcomes: off, problems: on}
)")
                                      .Record->BlackBox;
    EXPECT_EQ(box.Before, 120s);
    EXPECT_EQ(box.After, 5s);
    EXPECT_EQ(box.Messages, std::vector<std::string>{"Alarm"});
    EXPECT_EQ(box.Queues, std::vector<std::string>{"MissionControl"});
    EXPECT_FALSE(box.Outcomes);
    EXPECT_TRUE(box.Problems);
}

TEST_F(GatewayConfigTest, ReadsWhetherReportsAreSent)
{
    EXPECT_TRUE(Load("node: a\n").Reports);
    EXPECT_FALSE(Load("node: a\nreports: off\n").Reports);
}

TEST_F(GatewayConfigTest, ReadsWhoseProblemsAreRequested)
{
    EXPECT_TRUE(Load("node: a\n").ProblemsOf.empty());
    EXPECT_EQ(Load("node: a\nproblems_of: [\"uav*\", b]\n").ProblemsOf,
              (std::vector<std::string>{"uav*", "b"}));
    EXPECT_EQ(ErrorOf("node: a\nproblems_of: [\"u v\"]\n"),
              "node.yaml:2: `u v` in `problems_of` is no node name; `*` and `?` stand for any characters");
}

TEST_F(GatewayConfigTest, ReadsEveryKey)
{
    const GatewayConfig config = Load(R"(
node: uav1
name: Radio
domain: 7
transport: fastdds
interfaces: [lo, 127.0.0.1]
peers: 10.0.0.2
multicast: off
max_datagram: 65000
shared_memory: on
lease: 2s
lost_after: 90s
backend_config: vendor.xml
state_dir: /var/lib/rabit
radio:
  budget: 1.5kB/s
  slowest_beat: 2s
publish:
  - {message: Pose, type: Uav::Pose, qos: telemetry, max_rate: 10, class: command, weight: 3}
  - {message: MissionState, type: Uav::MissionState}
subscribe:
  - {message: Pose, type: Uav::Pose, from: ["uav*", ground], qos: telemetry}
accept:
  - {queue: MissionControl, types: [Uav::Goto, Uav::TargetReport]}
send:
  - {to: "uav?", queue: MissionControl, capacity: 50, capacity_bytes: 100000, expire: 1500ms, window: 8,
     redeliver_in_doubt: on, class: bulk, weight: 0.5}
)");
    EXPECT_EQ(config.Node, "uav1");
    EXPECT_EQ(config.Name, "Radio");
    EXPECT_EQ(config.Domain, 7);
    EXPECT_EQ(config.Interfaces, (std::vector<std::string>{"lo", "127.0.0.1"}));
    EXPECT_EQ(config.Peers, std::vector<std::string>{"10.0.0.2"});
    EXPECT_FALSE(config.Multicast);
    EXPECT_EQ(config.MaxDatagram, 65000u);
    EXPECT_TRUE(config.SharedMemory);
    EXPECT_EQ(config.Lease, 2s);
    EXPECT_EQ(config.LostAfter, 90s);
    EXPECT_EQ(config.BackendConfig, "vendor.xml");
    EXPECT_EQ(config.StateDir, "/var/lib/rabit");
    EXPECT_EQ(config.Radio.Budget, 1500.0);
    EXPECT_EQ(config.Radio.SlowestBeat, 2s);
    ASSERT_EQ(config.Publish.size(), 2u);
    EXPECT_EQ(config.Publish[0].Qos, QosProfile::Telemetry);
    EXPECT_EQ(config.Publish[0].MaxRate, 10.0);
    EXPECT_EQ(config.Publish[0].Class, TrafficClass::Command);
    EXPECT_EQ(config.Publish[0].Weight, 3.0);
    EXPECT_EQ(config.Publish[1].Qos, QosProfile::State);
    EXPECT_EQ(config.Publish[1].Class, std::nullopt);
    ASSERT_EQ(config.Subscribe.size(), 1u);
    EXPECT_EQ(config.Subscribe[0].From, (std::vector<std::string>{"uav*", "ground"}));
    EXPECT_EQ(config.Subscribe[0].Qos, QosProfile::Telemetry);
    ASSERT_EQ(config.Accept.size(), 1u);
    EXPECT_EQ(config.Accept[0].Types, (std::vector<std::string>{"Uav::Goto", "Uav::TargetReport"}));
    ASSERT_EQ(config.Send.size(), 1u);
    EXPECT_EQ(config.Send[0].Expire, 1500ms);
    EXPECT_EQ(config.Send[0].Window, 8u);
    EXPECT_TRUE(config.Send[0].RedeliverInDoubt);
    EXPECT_EQ(config.Send[0].Class, TrafficClass::Bulk);
    EXPECT_EQ(config.Send[0].Weight, 0.5);
}

TEST_F(GatewayConfigTest, ReadsTheParametersOfTheProgramByTheirKinds)
{
    const GatewayConfig config = Load(R"(
node: uav1
parameters: {spacing_m: 20.5, wingmen: 5, leader: uav1, strict: on, patience: 500ms, route: [a, b]}
)");
    double spacing = 0;
    int wingmen = 0;
    std::string leader;
    bool strict = false;
    std::chrono::milliseconds patience{0};
    std::vector<std::string> route;
    double missing = 7;
    config.Parameters.Read("spacing_m", spacing, 1, 100);
    config.Parameters.Read("wingmen", wingmen);
    config.Parameters.Read("leader", leader);
    config.Parameters.Read("strict", strict);
    config.Parameters.Read("patience", patience);
    config.Parameters.Read("route", route);
    config.Parameters.Read("missing", missing);
    EXPECT_EQ(spacing, 20.5);
    EXPECT_EQ(wingmen, 5);
    EXPECT_EQ(leader, "uav1");
    EXPECT_TRUE(strict);
    EXPECT_EQ(patience, 500ms);
    EXPECT_EQ(route, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(missing, 7);
    EXPECT_NO_THROW(config.Parameters.RefuseOthers());
}

// Returns what `use` throws, without the folder.
std::string ErrorIn(const std::function<void()> &use)
{
    try
    {
        use();
    }
    catch (const ConfigError &error)
    {
        const std::string text = error.what();
        return text.substr(text.rfind('/') + 1);
    }
    return "no error";
}

TEST_F(GatewayConfigTest, APathHasNetworkSettingsOfItsOwn)
{
    const GatewayConfig config = Load(R"(node: uav1
transport: cyclonedds
security: {keys: keys/uav1}
paths:
  - {name: mesh, interfaces: [wlan0]}
  - {name: modem, transport: fastdds, interfaces: [ppp0], peers: [10.8.0.1], multicast: off,
     radio: {budget: 1500B/s}, security: {keys: other/uav1}}
)");
    ASSERT_EQ(config.Paths.size(), 2U);
    const std::vector<GatewayConfig> paths = PathConfigsOf(config);
    EXPECT_EQ(paths[0].Transport, "cyclonedds");
    EXPECT_EQ(paths[0].Interfaces, std::vector<std::string>{"wlan0"});
    EXPECT_EQ(paths[0].Security->Keys, "keys/uav1");
    EXPECT_EQ(paths[1].Transport, "fastdds");
    EXPECT_EQ(paths[1].Peers, std::vector<std::string>{"10.8.0.1"});
    EXPECT_FALSE(paths[1].Multicast);
    EXPECT_EQ(paths[1].Radio.Budget, 1500.0);
    EXPECT_EQ(paths[1].Security->Keys, "other/uav1");
    EXPECT_EQ(paths[0].Lines.at("security"), config.Lines.at("security"));
    EXPECT_EQ(paths[1].Lines.at("security"), config.Lines.at("paths.modem.security"));
}

TEST_F(GatewayConfigTest, WithoutPathsThereIsOneWithTheSettingsOfTheGateway)
{
    const std::vector<GatewayConfig> paths = PathConfigsOf(Load("node: a\ninterfaces: [eth0]\n"));
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].Interfaces, std::vector<std::string>{"eth0"});
}

TEST_F(GatewayConfigTest, OtherInterfacesKeepTheKeysAndTheBudgetOfThePathThatNamesThem)
{
    const std::string yaml =
        "node: a\npaths:\n  - {name: mesh, interfaces: [wlan0], security: {keys: k1}}\n"
        "  - {name: modem, interfaces: [ppp0], radio: {budget: 1500B/s}, security: {keys: k2}}\n";
    GatewayConfig modem = Load(yaml);
    UseInterfaces({"ppp0"}, modem);
    EXPECT_TRUE(modem.Paths.empty());
    EXPECT_EQ(modem.Interfaces, std::vector<std::string>{"ppp0"});
    EXPECT_EQ(modem.Security->Keys, "k2");
    EXPECT_EQ(modem.Radio.Budget, 1500.0);
    GatewayConfig other = Load(yaml);
    UseInterfaces({"lo"}, other);
    EXPECT_EQ(other.Interfaces, std::vector<std::string>{"lo"});
    EXPECT_EQ(other.Security->Keys, "k1");
}

TEST_F(GatewayConfigTest, MistakesInPathsNameTheirLine)
{
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - {interfaces: [wlan0]}\n"),
              "node.yaml:3: a `paths` entry needs the key `name`");
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - {name: m}\n  - {name: m}\n"),
              "node.yaml:4: `m` stands twice under `paths` (first in line 3)");
    EXPECT_EQ(ErrorOf("node: a\ninterfaces: [eth0]\npaths:\n  - {name: m}\n"),
              "node.yaml:2: with `paths`, `interfaces` belongs to a path");
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - name: m\n    radio: {budget: 1B/s}\n").substr(0, 50),
              "node.yaml:4: the budget is too small to say that t");
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - {name: m, interface: wlan0}\n").substr(0, 12), "node.yaml:3:");
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - {name: m/n}\n"),
              "node.yaml:3: `m/n` is no path name; expected 1 to 64 of A-Z a-z 0-9 _ . -");
}

TEST_F(GatewayConfigTest, TwoPathsOfOneNetworkAreRefused)
{
    EXPECT_EQ(
        ErrorOf("node: a\npaths:\n  - {name: m, interfaces: [eth0]}\n  - {name: n, interfaces: [eth0]}\n"),
        "node.yaml:4: `eth0` stands twice under `interfaces` (first in line 3)");
    EXPECT_EQ(ErrorOf("node: a\npaths:\n  - {name: m, interfaces: [eth0]}\n  - {name: n}\n"),
              "node.yaml:4: path `n` needs `interfaces`: without them it uses those of the other paths, too");
}

TEST_F(GatewayConfigTest, AParameterOfAnotherKindOrRangeIsNamedWithItsLine)
{
    const GatewayConfig config =
        Load("node: uav1\nparameters:\n  spacing_m: wide\n  wingmen: 9\n  gap_m: 500\n");
    double number = 3;
    int whole = 4;
    EXPECT_EQ(ErrorIn([&] { config.Parameters.Read("spacing_m", number); }),
              "node.yaml:3: `spacing_m` is `wide`; expected a number");
    EXPECT_EQ(ErrorIn([&] { config.Parameters.Read("wingmen", whole, 1, 5); }),
              "node.yaml:4: `wingmen` is `9`; expected a whole number from 1 to 5");
    EXPECT_EQ(ErrorIn([&] { config.Parameters.Read("gap_m", number, 5, 200); }),
              "node.yaml:5: `gap_m` is `500`; expected a number from 5 to 200");
    EXPECT_EQ(number, 3);
    const GatewayConfig close = Load("node: uav1\nparameters:\n  gap_m: 200.0001\n");
    EXPECT_EQ(ErrorIn([&] { close.Parameters.Read("gap_m", number, 5, 200); }),
              "node.yaml:3: `gap_m` is `200.0001`; expected a number from 5 to 200");
    EXPECT_EQ(ErrorIn([&] { config.Parameters.Fail("gap_m", "too wide for the field"); }),
              "node.yaml:5: too wide for the field");
}

TEST_F(GatewayConfigTest, AParameterThatNothingReadsIsRefusedUnlessOthersAreAllowed)
{
    const std::string yaml = "node: uav1\nparameters:\n  spacing: 20\n";
    double spacing = 0;
    const GatewayConfig config = Load(yaml);
    EXPECT_EQ(ErrorIn([&] { config.Parameters.RefuseOthers(); }),
              "node.yaml:3: unknown parameter `spacing`; this program reads none");
    config.Parameters.Read("spacing_m", spacing);
    const GatewayConfig copy = config;
    EXPECT_EQ(ErrorIn([&] { copy.Parameters.RefuseOthers(); }),
              "node.yaml:3: unknown parameter `spacing`; did you mean `spacing_m`?");
    copy.Parameters.AllowOthers();
    EXPECT_NO_THROW(config.Parameters.RefuseOthers());
}

TEST_F(GatewayConfigTest, ParametersAreAMapping)
{
    EXPECT_EQ(ErrorOf("node: uav1\nparameters: [1, 2]\n"),
              "node.yaml:2: the section `parameters` must be a mapping of keys to values");
    EXPECT_EQ(ErrorOf("node: uav1\nparameters:\n  a: 1\n  a: 2\n"),
              "node.yaml:4: key `a` stands twice in the section `parameters`");
    EXPECT_NO_THROW(Load("node: uav1\n").Parameters.RefuseOthers());
}

TEST_F(GatewayConfigTest, TheBestPathTellsHowSoonANodeMayBeLost)
{
    const std::string paths =
        "paths:\n  - {name: mesh, interfaces: [wlan0]}\n  - {name: modem, interfaces: [ppp0], radio: "
        "{budget: 2kB/s}}\n";
    EXPECT_EQ(Load("node: a\nlost_after: 1500ms\n" + paths).LostAfter, 1500ms);
    EXPECT_FALSE(Load("node: a\n" + paths).LostAfter);
}

TEST_F(GatewayConfigTest, ABudgetIsInBytesASecondOrAuto)
{
    EXPECT_EQ(Load("node: a\nradio: {budget: 1500B/s}\n").Radio.Budget, 1500.0);
    EXPECT_EQ(Load("node: a\nradio: {budget: 5kB/s}\n").Radio.Budget, 5000.0);
    EXPECT_EQ(Load("node: a\nradio: {budget: 1.2MB/s}\n").Radio.Budget, 1.2e6);
    EXPECT_EQ(Load("node: a\nradio: {budget: auto}\n").Radio.Budget, std::nullopt);
    EXPECT_EQ(Load("node: a\n").Radio.Budget, std::nullopt);
    EXPECT_EQ(Load("node: a\nradio: {slowest_beat: 10s}\n").Radio.SlowestBeat, 10s);
}

TEST_F(GatewayConfigTest, TheSmallestBudgetThatIsNamedIsTaken)
{
    EXPECT_NO_THROW(Load("node: a\nradio: {budget: 400B/s}\n"));
    EXPECT_NO_THROW(Load("node: a\nradio: {budget: 700B/s, slowest_beat: 1s}\n"));
    EXPECT_NO_THROW(Load("node: a\nradio: {budget: 1000MB/s}\n"));
}

TEST_F(GatewayConfigTest, NobodyTakesTheClassOfForeignTopicsInCode)
{
    GatewayConfig config;
    config.Node = "a";
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose", .Class = TrafficClass::Foreign});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
}

TEST_F(GatewayConfigTest, NobodyTakesTheClassOfPresenceInCode)
{
    GatewayConfig config;
    config.Node = "a";
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose", .Class = TrafficClass::Presence});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
    config.Publish[0].Class = TrafficClass::Bulk;
    EXPECT_NO_THROW(ValidateGatewayConfig(config));
    config.Send.push_back({.Class = TrafficClass::Presence});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
}

TEST_F(GatewayConfigTest, AMessageMayBePublishedAndSubscribedWithOneType)
{
    const GatewayConfig config = Load(R"(
node: uav1
publish:
  - {message: Pose, type: Uav::Pose, qos: telemetry}
subscribe:
  - {message: Pose, type: Uav::Pose, qos: state}
)");
    EXPECT_EQ(config.Subscribe[0].Type, config.Publish[0].Type);
}

TEST_F(GatewayConfigTest, ASendEntryMayNameQueuesByAPatternAndTheSpecialOnesFirst)
{
    const GatewayConfig config = Load(R"(
node: uav1
send:
  - {to: "uav*", queue: "Mission*", capacity: 10}
  - {to: "uav*", capacity: 20}
  - {capacity: 30}
)");
    EXPECT_EQ(config.Send[0].Queue, "Mission*");
}

TEST_F(GatewayConfigTest, TheTransportTakesEveryDatagramThatTheFileMayAskFor)
{
    EXPECT_EQ(Load("node: a\nmax_datagram: 1000\n").MaxDatagram, TransportSettings::SmallestDatagram);
    EXPECT_EQ(Load("node: a\nmax_datagram: 65000\n").MaxDatagram, TransportSettings::LargestDatagram);
    GatewayConfig made;
    made.Node = "a";
    made.MaxDatagram = 500;
    EXPECT_THROW(ValidateGatewayConfig(made), ConfigError);
}

TEST_F(GatewayConfigTest, TheNodeNameCanBeGivenBesideTheFile)
{
    EXPECT_EQ(Load("domain: 3\n", "uav2").Node, "uav2");
    EXPECT_EQ(Load("node: uav1\n", "uav2").Node, "uav2");
}

TEST_F(GatewayConfigTest, AFileThatIsNotThereIsNamed)
{
    try
    {
        LoadGatewayConfig((_folder / "missing.yaml").string());
        FAIL() << "no error";
    }
    catch (const ConfigError &error)
    {
        EXPECT_EQ(std::string(error.what()),
                  (_folder / "missing.yaml").string() +
                      ": cannot read the configuration: No such file or directory");
    }
}

struct BadConfig
{
    const char *Name;
    const char *Yaml;
    const char *Error;
};

// The texts are part of the interface: people read them in the field, without the documentation.
const BadConfig BadConfigs[] = {
    {"UnknownKey", "node: a\ndomian: 3\n",
     "node.yaml:2: unknown key `domian` in the configuration; did you mean `domain`?"},
    {"UnknownKeyInEntry", "node: a\npublish:\n  - {message: P, type: Uav::Pose, rate: 3}\n",
     "node.yaml:3: unknown key `rate` in a `publish` entry; expected one of `message`, `type`, `qos`, "
     "`max_rate`, `class`, `weight`"},
    {"RepeatedKey", "node: a\ndomain: 1\ndomain: 2\n",
     "node.yaml:3: key `domain` stands twice in the configuration"},
    {"NotYaml", "node: a\npublish: [\n", "node.yaml:3: not YAML: end of sequence flow not found"},
    {"SecondDocument", "node: a\n---\n\npublsh: [oops]\ndomain: 999\n",
     "node.yaml:2: a second document: a configuration is one"},
    {"DocumentAfterAnEnd", "node: a\n...\n# more\ndomain: 999\n",
     "node.yaml:2: a second document: a configuration is one"},
    {"DocumentAfterAnEmptyOne", "---\n---\nnode: a\n",
     "node.yaml:2: a second document: a configuration is one"},
    {"NotAMapping", "- node\n", "node.yaml:1: the configuration must be a mapping of keys to values"},
    {"Empty", "", "node.yaml: cannot read the configuration: it is empty"},
    {"NoNode", "domain: 1\n", "node.yaml:1: the configuration needs the key `node`"},
    {"BadNode", "domain: 1\nnode: a/b\n",
     "node.yaml:2: `a/b` is no node name; expected 1 to 64 of A-Z a-z 0-9 _ . -"},
    {"BadName", "node: a\nname: a b\n",
     "node.yaml:2: `a b` is no name of a gateway; expected 1 to 64 of A-Z a-z 0-9 _ . -"},
    {"NodeCalledAsTheGateway", "node: Gateway\n",
     "node.yaml:1: node and gateway are both called `Gateway`: messages of the two would have the same "
     "names"},
    {"WordForNumber", "node: a\ndomain: seven\n",
     "node.yaml:2: `domain` is `seven`; expected a whole number from 0 to 232"},
    {"NumberOutOfRange", "node: a\ndomain: 233\n",
     "node.yaml:2: `domain` is `233`; expected a whole number from 0 to 232"},
    {"ListForWord", "node: [a]\n", "node.yaml:1: `node` must be a word"},
    {"WordForList", "node: a\npublish: Pose\n",
     "node.yaml:2: `publish` must be a list; each entry starts with `- `"},
    {"WordForEntry", "node: a\npublish:\n  - Pose\n",
     "node.yaml:3: a `publish` entry must be a mapping of keys to values"},
    {"MissingType", "node: a\npublish:\n  - {message: Pose}\n",
     "node.yaml:3: a `publish` entry needs the key `type`"},
    {"UnknownType", "node: a\npublish:\n  - {message: Pose, type: Uav::Poze}\n",
     "node.yaml:3: unknown IDL type `Uav::Poze`; did you mean `Uav::Pose`?"},
    {"UnknownQos", "node: a\npublish:\n  - {message: Pose, type: Uav::Pose, qos: best}\n",
     "node.yaml:3: `qos` is `best`; expected one of `state`, `telemetry`"},
    {"NegativeRate", "node: a\npublish:\n  - {message: Pose, type: Uav::Pose, max_rate: -1}\n",
     "node.yaml:3: max_rate is out of range; expected 0 (no limit) to 1000000 a second"},
    {"PublishedTwice",
     "node: a\npublish:\n  - {message: Pose, type: Uav::Pose}\n  - {message: Pose, type: Uav::Pose}\n",
     "node.yaml:4: `Pose` stands twice under `publish` (first in line 3)"},
    {"PublishOfAMirroredMessage", "node: a\npublish:\n  - {message: b/Pose, type: Uav::Pose}\n",
     "node.yaml:3: `b/Pose` belongs to another node or to the gateway; expected a name without `/`"},
    {"AcceptedTwice",
     "node: a\naccept:\n  - {queue: Q, types: [Uav::Goto]}\n  - {queue: Q, types: [Uav::Goto]}\n",
     "node.yaml:4: `Q` stands twice under `accept` (first in line 3)"},
    {"AcceptsNothing", "node: a\naccept:\n  - {queue: Q, types: []}\n",
     "node.yaml:3: queue `Q` accepts no types; expected a list of IDL types"},
    {"BadFrom", "node: a\nsubscribe:\n  - {message: Pose, type: Uav::Pose, from: [\"uav 1\"]}\n",
     "node.yaml:3: `uav 1` in `from` is no node name; `*` and `?` stand for any characters"},
    {"TimeWithoutUnit", "node: a\nsend:\n  - {expire: 5}\n",
     "node.yaml:3: `expire` is `5`; expected a time such as 5s, 200ms or 2min"},
    {"NegativeTime", "node: a\nlease: -1s\n",
     "node.yaml:2: `lease` is `-1s`; expected a time such as 5s, 200ms or 2min"},
    {"LeaseTooShort", "node: a\nlease: 1ms\n",
     "node.yaml:2: the lease is out of range; expected 200ms to 3600s"},
    {"LostBeforeThreeBeats", "node: a\nlost_after: 1s\n",
     "node.yaml:2: `lost_after` is out of range; expected 1500ms to 3600s, as a node may beat each 500 ms"},
    {"LostBeforeThreeRareBeats", "node: a\nlost_after: 5s\nradio: {budget: 5kB/s}\n",
     "node.yaml:2: `lost_after` is out of range; expected 6000ms to 3600s, as a node may beat each 2000 ms"},
    {"LostMuchTooLate", "node: a\nlost_after: 61min\n",
     "node.yaml:2: `lost_after` is out of range; expected 1500ms to 3600s, as a node may beat each 500 ms"},
    {"ZeroCapacity", "node: a\nsend:\n  - {capacity: 0}\n",
     "node.yaml:3: `capacity` is `0`; expected a whole number from 1 to 1000000"},
    {"BadSwitch", "node: a\nmulticast: maybe\n",
     "node.yaml:2: `multicast` is `maybe`; expected one of `off`, `on`, `false`, `true`"},
    {"PublishedAndSubscribedWithOtherTypes",
     "node: a\npublish:\n  - {message: Pose, type: Uav::Pose}\nsubscribe:\n  - {message: Pose, type: "
     "Uav::Health}\n",
     "node.yaml:5: `Pose` is subscribed as `Uav::Health` and published as `Uav::Pose` in line 3; a message "
     "has "
     "one type"},
    {"SubscribedTwice",
     "node: a\nsubscribe:\n  - {message: Pose, type: Uav::Pose, from: [b]}\n"
     "  - {message: Pose, type: Uav::Pose, from: [c]}\n",
     "node.yaml:4: `Pose` stands twice under `subscribe` (first in line 3)"},
    {"TopicOfTheGateways", "node: a\nsubscribe:\n  - {message: rabit/Beat, type: Uav::Pose}\n",
     "node.yaml:3: `rabit/Beat` is a topic of the gateways themselves"},
    {"DatagramTooSmall", "node: a\nmax_datagram: 999\n",
     "node.yaml:2: `max_datagram` is `999`; expected a whole number from 1000 to 65000"},
    {"DatagramTooLarge", "node: a\nmax_datagram: 65001\n",
     "node.yaml:2: `max_datagram` is `65001`; expected a whole number from 1000 to 65000"},
    {"NodeTwiceInFrom", "node: a\nsubscribe:\n  - {message: Pose, type: Uav::Pose, from: [b, c, b]}\n",
     "node.yaml:3: `b` stands twice under `from`"},
    {"InterfaceTwice", "node: a\ninterfaces: [wlan0, wlan0]\n",
     "node.yaml:2: `wlan0` stands twice under `interfaces`"},
    {"PeerTwice", "node: a\npeers: [10.0.0.1, 10.0.0.1]\n",
     "node.yaml:2: `10.0.0.1` stands twice under `peers`"},
    {"BadQueuePattern", "node: a\nsend:\n  - {queue: \"Mission *\"}\n",
     "node.yaml:3: `Mission *` is no queue name; expected 1 to 200 of A-Z a-z 0-9 _ . - : /"},
    {"SendNeverUsed",
     "node: a\nsend:\n  - {to: \"*\", capacity: 10}\n  - {to: \"uav*\", queue: Q, capacity: 20}\n",
     "node.yaml:4: this `send` entry is never used: `*/*` in line 3 fits all that `uav*/Q` fits, and the "
     "first "
     "that fits holds"},
    {"BudgetWithoutUnit", "node: a\nradio:\n  budget: 1500\n",
     "node.yaml:3: `budget` is `1500`; expected auto, or bytes a second such as 1500B/s or 5kB/s"},
    {"BudgetInBits", "node: a\nradio:\n  budget: 57.6kbit/s\n",
     "node.yaml:3: `budget` is `57.6kbit/s`; expected auto, or bytes a second such as 1500B/s or 5kB/s"},
    {"BudgetTooSmall", "node: a\nradio:\n  slowest_beat: 5s\n  budget: 199B/s\n",
     "node.yaml:4: the budget is too small to say that this node is there; expected 200B/s or more"},
    {"BudgetTooSmallForItsBeats", "node: a\nradio:\n  budget: 600B/s\n  slowest_beat: 1s\n",
     "node.yaml:3: the budget is too small to say that this node is there; expected 700B/s or more"},
    {"BudgetTooLarge", "node: a\nradio:\n  budget: 1001MB/s\n",
     "node.yaml:3: the budget is out of range; expected 1000MB/s or less, or auto"},
    {"BeatsTooSlow", "node: a\nradio:\n  slowest_beat: 61s\n",
     "node.yaml:3: `slowest_beat` is out of range; expected 500ms to 60s"},
    {"UnknownKeyOfTheRadio", "node: a\nradio:\n  buget: 5kB/s\n",
     "node.yaml:3: unknown key `buget` in the section `radio`; did you mean `budget`?"},
    {"RecordWithoutFolder", "node: a\nrecord:\n  keep: 1GB\n",
     "node.yaml:3: the section `record` needs the key `folder`"},
    {"RecordIntoNothing", "node: a\nrecord:\n  folder: \"\"\n", "node.yaml:3: `folder` must be a word"},
    {"UnknownKeyOfTheRecording", "node: a\nrecord:\n  folder: x\n  split_siz: 1GB\n",
     "node.yaml:4: unknown key `split_siz` in the section `record`; did you mean `split_size`?"},
    {"SizeWithoutUnit", "node: a\nrecord:\n  folder: x\n  keep: 1000\n",
     "node.yaml:4: `keep` is `1000`; expected bytes such as 64MB or 1GB"},
    {"SplitTooSmall", "node: a\nrecord:\n  folder: x\n  split_size: 10kB\n",
     "node.yaml:4: `split_size` is `10kB`; expected 1MB to 1TB"},
    {"SplitTooLong", "node: a\nrecord:\n  folder: x\n  split_time: 1441min\n",
     "node.yaml:4: `split_time` is out of range; expected 1s to 1440min"},
    {"BlackBoxTooLong", "node: a\nrecord:\n  folder: x\n  black_box:\n    before: 2s\n    after: 61min\n",
     "node.yaml:6: `after` is out of range; expected 1s to 60min"},
    {"NoNameOfAMessageForTheBlackBox", "node: a\nrecord:\n  folder: x\n  black_box: {messages: [\"a b\"]}\n",
     "node.yaml:4: `a b` in `messages` is no message name; `*` and `?` stand for any characters"},
    {"NoNameOfAManagerToRecord", "node: a\nrecord:\n  folder: x\n  steps: [\"a b\"]\n",
     "node.yaml:4: `a b` in `steps` is no name of a manager; `*` and `?` stand for any characters"},
    {"BackfillOfNoSubscription",
     "node: a\nsubscribe:\n  - {message: Pose, type: Uav::Pose}\nrecord:\n  folder: x\n  backfill: [Pos]\n",
     "node.yaml:6: `backfill` names `Pos`, which no `subscribe` entry names; did you mean `Pose`?"},
    {"BackfillBesideABlackBox",
     "node: a\nsubscribe:\n  - {message: Pose, type: Uav::Pose}\nrecord:\n  folder: x\n  black_box: {}\n"
     "  backfill: [Pose]\n",
     "node.yaml:7: `backfill` needs a recording of everything, and `black_box` drops most of it; remove one "
     "of them"},
    {"BackfillOfTooLong", "node: a\nrecord:\n  folder: x\n  backfill_last: 1441min\n",
     "node.yaml:4: `backfill_last` is out of range; expected 1s to 1440min"},
    {"FetchByNobodyNamed", "node: a\nfetch:\n  folder: x\n",
     "node.yaml:3: the section `fetch` needs the key `from`"},
    {"FetchFromNowhere", "node: a\nfetch:\n  folder: \"\"\n  from: [ground]\n",
     "node.yaml:3: `folder` must be a word"},
    {"NoNameOfAMessageToRecord", "node: a\nrecord:\n  folder: x\n  except: [\"a b\"]\n",
     "node.yaml:4: `a b` in `except` is no message name; `*` and `?` stand for any characters"},
    {"WordForRadio", "node: a\nradio: auto\n",
     "node.yaml:2: the section `radio` must be a mapping of keys to values"},
    {"UnknownClass", "node: a\npublish:\n  - {message: Pose, type: Uav::Pose, class: telemetri}\n",
     "node.yaml:3: `class` is `telemetri`; did you mean `telemetry`?"},
    {"ClassOfPresence", "node: a\nsend:\n  - {class: presence}\n",
     "node.yaml:3: `class` is `presence`; expected one of `command`, `state`, `telemetry`, `bulk`"},
    {"WeightTooLarge", "node: a\npublish:\n  - {message: Pose, type: Uav::Pose, weight: 101}\n",
     "node.yaml:3: `weight` is out of range; expected 0.01 to 100"},
    {"NoWeight", "node: a\nsend:\n  - {weight: 0}\n",
     "node.yaml:3: `weight` is out of range; expected 0.01 to 100"},
    {"EmptyValue", "node:\n", "node.yaml:1: key `node` in the configuration has no value"},
};

class BadConfigTest : public GatewayConfigTest, public ::testing::WithParamInterface<BadConfig>
{
};

TEST_P(BadConfigTest, IsRefusedWithPlaceAndExpectation)
{
    EXPECT_EQ(ErrorOf(GetParam().Yaml), GetParam().Error);
}

INSTANTIATE_TEST_SUITE_P(All, BadConfigTest, ::testing::ValuesIn(BadConfigs),
                         [](const auto &bad) { return std::string(bad.param.Name); });

TEST_F(GatewayConfigTest, AnUnknownTransportIsNamedWithItsLine)
{
    const GatewayConfig config = Load("node: a\ntransport: fastdsd\n");
    try
    {
        ValidateTransportName(config, {"fastdds", "cyclonedds"});
        FAIL() << "no error";
    }
    catch (const ConfigError &error)
    {
        EXPECT_EQ(std::string(error.what()), (_folder / "node.yaml").string() +
                                                 ":2: unknown transport `fastdsd`; did you mean `fastdds`?");
    }
}

TEST_F(GatewayConfigTest, ATransportThatWasLeftOutOfTheBuildIsSaidToBe)
{
    const GatewayConfig config = Load("node: a\ntransport: cyclonedds\n");
    try
    {
        ValidateTransportName(config, {"fastdds"}, {"fastdds", "cyclonedds"});
        FAIL() << "no error";
    }
    catch (const ConfigError &error)
    {
        EXPECT_EQ(std::string(error.what()),
                  (_folder / "node.yaml").string() +
                      ":2: this build is without the transport `cyclonedds`; expected `fastdds`");
    }
}

TEST_F(GatewayConfigTest, AConfigurationMadeInCodeIsCheckedAlike)
{
    GatewayConfig config;
    config.Node = "uav1";
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Nothing"});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
    config.Publish[0].Type = "Uav::Pose";
    EXPECT_NO_THROW(ValidateGatewayConfig(config));
}

TEST_F(GatewayConfigTest, AToolThatPublishesOrAcceptsIsRefused)
{
    GatewayConfig config;
    config.Node = "tool";
    config.Tool.emplace();
    ValidateGatewayConfig(config);
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose"});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
    config.Publish.clear();
    config.Accept.push_back({.Queue = "Commands", .Types = {"Uav::Goto"}});
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
}

TEST_F(GatewayConfigTest, AConfigurationWhoseAnnouncementOthersWouldDropIsRefused)
{
    GatewayConfig config;
    config.Node = "a";
    for (int i = 0; i < 513; ++i)
    {
        config.Publish.push_back(
            {.Message = std::string("m").append(std::to_string(i)), .Type = "Uav::Pose"});
    }
    try
    {
        ValidateGatewayConfig(config);
        FAIL() << "accepted";
    }
    catch (const ConfigError &error)
    {
        EXPECT_STREQ(error.what(),
                     "this node would announce 513 messages and queues; others take at most 512");
    }
    config.Publish.pop_back();
    EXPECT_NO_THROW(ValidateGatewayConfig(config));
}

TEST_F(GatewayConfigTest, GarbledFilesAreRefusedOrReadButNeverEndTheProcess)
{
    const std::string good =
        "node: a\ndomain: 3\npublish:\n  - {message: Pose, type: Uav::Pose}\nsend:\n  - {expire: 5s}\n";
    std::uint32_t random = 1;
    int refused = 0;
    for (int run = 0; run < 500; ++run)
    {
        std::string bad = good;
        for (int edit = 0; edit < 3; ++edit)
        {
            random = random * 1664525u + 1013904223u;
            bad[(random >> 8) % bad.size()] = static_cast<char>(random >> 24);
        }
        try
        {
            Load(bad);
        }
        catch (const ConfigError &)
        {
            ++refused;
        }
    }
    EXPECT_GT(refused, 250);
}

TEST_F(GatewayConfigTest, ReadsAnAgreement)
{
    EXPECT_FALSE(Load("node: uav1\n").Agreement);
    const GatewayConfig config =
        Load("node: uav1\nagreement:\n  members: [ground, uav1, uav2]\n  lease: 4s\n");
    ASSERT_TRUE(config.Agreement);
    EXPECT_EQ(config.Agreement->Members, (std::vector<std::string>{"ground", "uav1", "uav2"}));
    EXPECT_EQ(config.Agreement->Lease, 4s);
    EXPECT_EQ(Load("node: uav1\nagreement: {members: [uav1]}\n").Agreement->Lease, 2s);
}

TEST_F(GatewayConfigTest, SaysWhatIsWrongWithAnAgreement)
{
    EXPECT_EQ(ErrorOf("node: uav1\nagreement:\n  members: []\n"),
              "node.yaml:3: `members` has 0 nodes; expected 1 to 64");
    EXPECT_EQ(ErrorOf("node: uav1\nagreement:\n  members: [uav1, \"uav*\"]\n"),
              "node.yaml:3: `uav*` in `members` is no node name; expected 1 to 64 of A-Z a-z 0-9 _ . -");
    EXPECT_EQ(ErrorOf("node: uav1\nagreement:\n  members: [uav1, uav2, uav1]\n"),
              "node.yaml:3: `uav1` stands twice under `members`");
    EXPECT_EQ(ErrorOf("node: uav1\nagreement:\n  members: [ground, uav11]\n"),
              "node.yaml:3: this node, `uav1`, is not in `members`; did you mean `uav11`?");
    EXPECT_EQ(ErrorOf("node: uav1\nagreement:\n  members: [uav1]\n  lease: 1s\n"),
              "node.yaml:4: `lease` is out of range; expected 2000ms (four of the slowest beats) to 60s, the "
              "same at all members");
    EXPECT_EQ(ErrorOf("node: uav1\nradio: {budget: 5kB/s}\nagreement: {members: [uav1]}\n"),
              "node.yaml:3: `lease` is out of range; expected 8000ms (four of the slowest beats) to 60s, the "
              "same at all members");
    std::string many = "node: uav1\nagreement:\n  members: [uav1";
    for (std::size_t i = 0; i < MostAgreementMembers; ++i)
    {
        many += ", m" + std::to_string(i);
    }
    EXPECT_EQ(ErrorOf(many + "]\n"), "node.yaml:3: `members` has 65 nodes; expected 1 to 64");
}

}  // namespace
}  // namespace Rabit
