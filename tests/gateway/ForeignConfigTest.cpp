// The section `foreign` of a configuration.
#include <gtest/gtest.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "configuration/ForeignEntries.h"
#include "names/ForeignNames.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class ForeignConfigTest : public ::testing::Test
{
protected:
    ~ForeignConfigTest() override { std::filesystem::remove(_file); }

    GatewayConfig Load(const std::string &entries) const
    {
        std::ofstream(_file) << "node: uav1\n" << entries;
        return LoadGatewayConfig(_file.string(), "");
    }

    std::string ErrorOf(const std::string &entries) const
    {
        try
        {
            Load(entries);
        }
        catch (const ConfigError &error)
        {
            return std::string(error.what()).substr(_file.parent_path().string().size() + 1);
        }
        return "no error";
    }

    // Returns the error of an entry in line 3, without file and line.
    std::string Refusal(const std::string &entry) const
    {
        const std::string error = ErrorOf("foreign:\n  - {" + entry + "}\n");
        const std::string place = _file.filename().string() + ":3: ";
        return error.rfind(place, 0) == 0 ? error.substr(place.size()) : error;
    }

    const std::filesystem::path _file = std::filesystem::path(::testing::TempDir()) /
                                        ("rabit-foreign-" + std::to_string(::getpid()) + ".yaml");
};

TEST_F(ForeignConfigTest, ReadsEveryKeyOfATopicThatIsRead)
{
    const ForeignRule rule =
        Load(
            "foreign:\n  - {subscribe: rt/odometry, type: Uav::Pose, as: Autopilot/Odometry, "
            "names: ros2, each: latest, stale_after: 500ms, age: source_time, capacity: 7, capacity_bytes: "
            "70, "
            "reliability: best_effort, durability: transient_local}\n")
            .Foreign.at(0);
    EXPECT_EQ(rule.Way, ForeignRule::Direction::Subscribe);
    EXPECT_EQ(rule.Topic, "rt/odometry");
    EXPECT_EQ(rule.Type, "Uav::Pose");
    EXPECT_EQ(rule.Local, "Autopilot/Odometry");
    EXPECT_EQ(rule.Names, ForeignRule::WireNames::Ros2);
    EXPECT_EQ(rule.Each, ForeignRule::Delivery::Latest);
    EXPECT_EQ(rule.StaleAfter, 500ms);
    EXPECT_TRUE(rule.SourceTimeIsTrusted);
    EXPECT_EQ(rule.Capacity, 7u);
    EXPECT_EQ(rule.CapacityBytes, 70u);
    EXPECT_EQ(rule.Reliability, Reliability::BestEffort);
    EXPECT_EQ(rule.Durability, Durability::TransientLocal);
    EXPECT_EQ(rule.Line, 3);
    EXPECT_EQ(WireTypeOf(rule), "Uav::dds_::Pose_");
    EXPECT_EQ(WireTopicOf(rule), "rt/odometry");
}

TEST_F(ForeignConfigTest, AToolReadsTopicsAndWritesNone)
{
    GatewayConfig config = Load("foreign:\n  - {subscribe: rt/odometry, type: Uav::Pose, as: Odometry}\n");
    config.Tool.emplace();
    EXPECT_NO_THROW(ValidateGatewayConfig(config));
    config.Foreign[0].Way = ForeignRule::Direction::Publish;
    EXPECT_THROW(ValidateGatewayConfig(config), ConfigError);
}

TEST_F(ForeignConfigTest, ReadsEveryKeyOfATopicThatIsWritten)
{
    const ForeignRule rule =
        Load(
            "foreign:\n  - {publish: Setpoint, topic: setpoint, type: Uav::Pose, names: plain, "
            "reliability: reliable, durability: volatile, depth: 3, max_rate: 20}\n")
            .Foreign.at(0);
    EXPECT_EQ(rule.Way, ForeignRule::Direction::Publish);
    EXPECT_EQ(rule.Local, "Setpoint");
    EXPECT_EQ(rule.Reliability, Reliability::Reliable);
    EXPECT_EQ(rule.Durability, Durability::Volatile);
    EXPECT_EQ(rule.Depth, 3u);
    EXPECT_EQ(rule.MaxRate, 20.0);
    EXPECT_EQ(WireTopicOf(rule), "setpoint");
    EXPECT_EQ(WireTypeOf(rule), "Uav::Pose");
}

TEST_F(ForeignConfigTest, ReadsEveryKeyOfAQueueThatIsWritten)
{
    const ForeignRule rule =
        Load(
            "foreign:\n  - {publish: Goals, topic: goals, type: Uav::Goto, each: queue, capacity: 7, "
            "capacity_bytes: 70}\n")
            .Foreign.at(0);
    EXPECT_EQ(rule.Way, ForeignRule::Direction::Publish);
    EXPECT_EQ(rule.Local, "Goals");
    EXPECT_EQ(rule.Each, ForeignRule::Delivery::Queue);
    EXPECT_EQ(rule.Capacity, 7u);
    EXPECT_EQ(rule.CapacityBytes, 70u);
    EXPECT_EQ(rule.Depth, std::nullopt);
}

TEST_F(ForeignConfigTest, RefusesAWrittenQueueOfTheNameOfAnotherQueue)
{
    const std::string file = _file.filename().string();
    const std::string written = "  - {publish: A, topic: a, type: Uav::Pose, each: queue}\n";
    EXPECT_EQ(ErrorOf("foreign:\n" + written + "  - {publish: A, topic: b, type: Uav::Pose, each: queue}\n"),
              file + ":4: `A` stands twice under `foreign` (first in line 3)");
    EXPECT_EQ(
        ErrorOf("foreign:\n" + written + "  - {subscribe: b, as: A, type: Uav::Pose, each: queue}\n"),
        file + ":3: the queue `A` is a manager's by line 4; expected a name that no manager's queue has");
    EXPECT_EQ(
        ErrorOf("accept:\n  - {queue: A, types: [Uav::Pose]}\nforeign:\n" + written),
        file + ":5: the queue `A` is a manager's by line 3; expected a name that no manager's queue has");
}

TEST_F(ForeignConfigTest, TakesQosAsItIsFoundUnlessItIsGiven)
{
    const ForeignRule rule =
        Load("foreign:\n  - {subscribe: a, type: Uav::Pose, as: A, each: queue, reliability: as_found}\n")
            .Foreign.at(0);
    EXPECT_EQ(rule.Reliability, std::nullopt);
    EXPECT_EQ(rule.Durability, std::nullopt);
    EXPECT_EQ(rule.Each, ForeignRule::Delivery::Queue);
    EXPECT_FALSE(rule.SourceTimeIsTrusted);
}

TEST_F(ForeignConfigTest, WritesAMessageToTheTopicOfItsNameIfThereIsNoOther)
{
    EXPECT_EQ(
        WireTopicOf(Load("foreign:\n  - {publish: Pose, type: Uav::Pose, names: ros2}\n").Foreign.at(0)),
        "rt/Pose");
}

TEST_F(ForeignConfigTest, RefusesWhatItDoesNotKnowWithTheNearestWord)
{
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Poze, as: A"),
              "unknown IDL type `Uav::Poze`; did you mean `Uav::Pose`?");
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: A, stale_afer: 1s"),
              "unknown key `stale_afer` in a `foreign` entry; did you mean `stale_after`?");
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: A, names: ros"),
              "`names` is `ros`; did you mean `ros2`?");
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: A, reliability: besteffort"),
              "`reliability` is `besteffort`; did you mean `best_effort`?");
}

TEST_F(ForeignConfigTest, RefusesKeysOfTheOtherDirection)
{
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: A, max_rate: 1"),
              "`max_rate` is not for an entry that subscribes");
    EXPECT_EQ(Refusal("publish: A, type: Uav::Pose, as: B"), "`as` is not for an entry that publishes");
    EXPECT_EQ(Refusal("publish: A, type: Uav::Pose, stale_after: 1s"),
              "`stale_after` is not for an entry that publishes");
    EXPECT_EQ(Refusal("publish: A, type: Uav::Pose, durability: as_found"),
              "`as_found` is not for an entry that publishes");
    EXPECT_EQ(Refusal("publish: A, subscribe: a, type: Uav::Pose"),
              "a `foreign` entry has either `subscribe` or `publish`");
    EXPECT_EQ(Refusal("type: Uav::Pose"), "a `foreign` entry has either `subscribe` or `publish`");
}

TEST_F(ForeignConfigTest, RefusesNamesAndRangesThatCannotBe)
{
    EXPECT_EQ(Refusal("subscribe: 'a b', type: Uav::Pose, as: A"),
              "`a b` is no topic name; expected 1 to 255 letters without blanks");
    EXPECT_EQ(Refusal("subscribe: rabit/Beat, type: Uav::Pose, as: A"),
              "`rabit/Beat` is a topic of the gateways themselves");
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: Gateway/Fleet"),
              "`Gateway/Fleet` belongs to the gateway; expected another name");
    EXPECT_EQ(Refusal("publish: 'A//B', type: Uav::Pose").substr(0, 37),
              "`A//B` is no name of a message or que");
    EXPECT_EQ(Refusal("publish: A, type: Uav::Pose, max_rate: -1"),
              "max_rate is out of range; expected 0 (no limit) to 1000000 a second");
}

TEST_F(ForeignConfigTest, RefusesAPatternOfTopics)
{
    EXPECT_EQ(Refusal("subscribe: '/*/pose', type: Uav::Pose, as: A, names: ros2"),
              "`/*/pose` is taken literally, as the name of one topic; expected a name without wildcards, "
              "and an entry for each topic");
    EXPECT_NE(Refusal("publish: A, topic: 'a?', type: Uav::Pose"), "no error");
}

TEST_F(ForeignConfigTest, RefusesATopicThatRosForbids)
{
    EXPECT_EQ(Refusal("subscribe: /uav-1/pose, type: Uav::Pose, as: A, names: ros2"),
              "`/uav-1/pose` is no topic name of ROS 2: it has `-`; ROS 2 allows A-Z a-z 0-9 _ /");
    EXPECT_EQ(Refusal("subscribe: /uav-1/pose, type: Uav::Pose, as: A"), "no error") << "a plain DDS name";
}

TEST_F(ForeignConfigTest, RefusesTheNameOfAMessageThatComesFromAnotherNode)
{
    const std::string entry = "foreign:\n  - {subscribe: a, type: Uav::Pose, as: uav2/Pose}\n";
    EXPECT_EQ(ErrorOf("subscribe:\n  - {message: Pose, type: Uav::Pose, from: [\"uav*\"]}\n" + entry),
              _file.filename().string() +
                  ":5: `uav2/Pose` is the message of the node `uav2` that `subscribe` brings in line 3; "
                  "expected another name");
    EXPECT_EQ(ErrorOf("subscribe:\n  - {message: Pose, type: Uav::Pose, from: [ground]}\n" + entry),
              "no error");
    EXPECT_EQ(ErrorOf("subscribe:\n  - {message: Pose, type: Uav::Pose}\n" + entry), "no error");
}

// Returns the error of a rule that a program made, as if it stood in line 7.
std::string RefusalOf(const std::function<void(ForeignRule &)> &spoil)
{
    ForeignRule rule;
    rule.Topic = "a";
    rule.Type = "Uav::Pose";
    rule.Local = "A";
    rule.Line = 7;
    spoil(rule);
    GatewayConfig config;
    config.File = "uav.yaml";
    config.Foreign = {rule};
    try
    {
        CheckForeign(config, [](const std::string &) { return std::string(); });
    }
    catch (const ConfigError &error)
    {
        return error.what();
    }
    return "no error";
}

TEST_F(ForeignConfigTest, RefusesAStaleAfterBelowZeroAndAboveADay)
{
    EXPECT_EQ(Refusal("subscribe: a, type: Uav::Pose, as: A, stale_after: 1441min"),
              "`stale_after` is out of range; expected 0s (never) to a day");
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.StaleAfter = -1ms; }),
              "uav.yaml:7: `stale_after` is out of range; expected 0s (never) to a day");
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.StaleAfter = 24h + 1ms; }),
              "uav.yaml:7: `stale_after` is out of range; expected 0s (never) to a day");
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.StaleAfter = 24h; }), "no error");
}

TEST_F(ForeignConfigTest, RefusesAMaxRateBelowZeroAboveAMillionAndNone)
{
    constexpr auto error = "uav.yaml:7: max_rate is out of range; expected 0 (no limit) to 1000000 a second";
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.MaxRate = -0.1; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.MaxRate = 1e6 + 1; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.MaxRate = std::nan(""); }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.MaxRate = 1e6; }), "no error");
}

TEST_F(ForeignConfigTest, RefusesADepthOfNoneAndAboveTenThousand)
{
    constexpr auto error = "uav.yaml:7: `depth` is out of range; expected 1 to 10000";
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Depth = 0; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Depth = 10'001; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Depth = 10'000; }), "no error");
}

TEST_F(ForeignConfigTest, RefusesACapacityOfNoneAndAboveAMillion)
{
    constexpr auto error = "uav.yaml:7: `capacity` is out of range; expected 1 to 1000000";
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Capacity = 0; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Capacity = 1'000'001; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Capacity = 1'000'000; }), "no error");
}

TEST_F(ForeignConfigTest, RefusesCapacityBytesOfNoneAndAboveATebibyte)
{
    constexpr auto error = "uav.yaml:7: `capacity_bytes` is out of range; expected 1 to 1099511627776";
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.CapacityBytes = 0; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.CapacityBytes = (std::size_t{1} << 40) + 1; }), error);
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.CapacityBytes = std::size_t{1} << 40; }), "no error");
}

TEST_F(ForeignConfigTest, RefusesATopicNameAbove255Letters)
{
    EXPECT_EQ(RefusalOf([](ForeignRule &rule) { rule.Topic.assign(255, 'a'); }), "no error");
    EXPECT_NE(RefusalOf([](ForeignRule &rule) { rule.Topic.assign(256, 'a'); }), "no error");
}

TEST_F(ForeignConfigTest, RefusesATopicOrMessageOfTwoTypes)
{
    const std::string file = _file.filename().string();
    EXPECT_EQ(ErrorOf("foreign:\n  - {subscribe: a, type: Uav::Pose, as: A}\n  - {publish: B, topic: a, "
                      "type: Uav::Goto}\n"),
              file + ":4: the topic `a` is of type `Uav::Goto` here and `Uav::Pose` in line 3");
    EXPECT_EQ(ErrorOf("publish:\n  - {message: A, type: Uav::Pose}\nforeign:\n  - {subscribe: a, type: "
                      "Uav::Goto, as: A}\n"),
              file + ":5: the message `A` is of type `Uav::Goto` here and `Uav::Pose` in line 3");
    EXPECT_EQ(ErrorOf("subscribe:\n  - {message: a, type: Uav::Pose}\nforeign:\n  - {subscribe: a, type: "
                      "Uav::Goto, as: A}\n"),
              file + ":5: the topic `a` is of type `Uav::Goto` here and `Uav::Pose` in line 3");
}

TEST_F(ForeignConfigTest, RefusesWhatStandsTwice)
{
    const std::string file = _file.filename().string();
    EXPECT_EQ(ErrorOf("foreign:\n  - {subscribe: a, type: Uav::Pose, as: A}\n  - {subscribe: a, type: "
                      "Uav::Pose, as: B}\n"),
              file + ":4: `a` stands twice under `foreign` (first in line 3)");
    EXPECT_EQ(ErrorOf("foreign:\n  - {subscribe: a, type: Uav::Pose, as: A}\n  - {subscribe: b, type: "
                      "Uav::Pose, as: A}\n"),
              file + ":4: `A` stands twice under `foreign` (first in line 3)");
}

TEST_F(ForeignConfigTest, RefusesToWriteATopicsSamplesBackToIt)
{
    EXPECT_EQ(ErrorOf("foreign:\n  - {subscribe: rt/a, type: Uav::Pose, as: A, names: ros2}\n"
                      "  - {publish: A, topic: a, type: Uav::Pose, names: ros2}\n"),
              _file.filename().string() + ":4: `A` would be written back to the topic that it comes from");
}

TEST_F(ForeignConfigTest, MayMirrorATopicOnToOtherNodesUnderTheNameOfThisOne)
{
    const GatewayConfig config = Load(
        "publish:\n  - {message: A, type: Uav::Pose}\nforeign:\n  - {subscribe: a, type: Uav::Pose, as: "
        "A}\n");
    EXPECT_EQ(config.Foreign.size(), 1u);
}

}  // namespace
}  // namespace Rabit
