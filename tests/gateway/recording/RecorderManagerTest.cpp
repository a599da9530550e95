// Recordings of whole nodes on the simulated network.
#include <rabit/RabitLog.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/recording/RecorderManager.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <map>
#include <set>
#include <string>

#include "../../Eventually.h"
#include "../ForeignNetwork.h"
#include "../PlainProgram.h"
#include "../SimulatedFleet.h"
#include "FakeDisk.h"
#include "foreign/ForeignReader.h"
#include "recording/RecordingTarget.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using Json = nlohmann::json;

// A disk that outlives the recorder, which owns one.
class SharedDisk final : public RecordingDisk
{
public:
    explicit SharedDisk(std::shared_ptr<FakeDisk> disk) : _disk(std::move(disk)) {}
    std::unique_ptr<File> Create(const std::string &name, std::string &reason) override
    {
        return _disk->Create(name, reason);
    }
    std::vector<Entry> List() override { return _disk->List(); }
    bool Remove(const std::string &name) override { return _disk->Remove(name); }
    std::optional<std::uint64_t> FreeBytes() override { return _disk->FreeBytes(); }

private:
    const std::shared_ptr<FakeDisk> _disk;
};

struct Recorded
{
    std::string Schema;
    std::string Kind;
    std::string Qos;
    std::vector<Mcap::Bytes> Samples;
    std::vector<std::uint32_t> Sequences;
    std::vector<std::uint64_t> LogTimes;
    std::vector<std::uint64_t> PublishTimes;

    Json JsonAt(std::size_t at) const { return Json::parse(Samples.at(at)); }
};

class RecorderManagerTest : public testing::Test
{
protected:
    SimulatedNode &AddRecorded(GatewayConfig config)
    {
        if (!config.Record)
        {
            config.Record = RecordSettings{.Folder = "/recordings"};
        }
        return Fleet.Add(config, 1.4e9, "",
                         [this](SimulatedNode &node, GatewayConfig &completed)
                         {
                             Disks[completed.Node] = std::make_shared<FakeDisk>();
                             auto recorder = std::make_unique<RecorderManager>(
                                 completed, node.Workspace,
                                 std::make_unique<SharedDisk>(Disks[completed.Node]));
                             Recorders[completed.Node] = recorder.get();
                             Taps[completed.Node] = completed.Tap;
                             node.Reactor.AddManager(std::move(recorder));
                         });
    }

    // Ends the node and returns its recording by topic.
    std::map<std::string, Recorded> RecordingOf(const std::string &node)
    {
        Fleet.Stop(node);
        std::map<std::string, Recorded> topics;
        for (const std::string &name : Disks.at(node)->Names())
        {
            MemoryFile file = Disks.at(node)->Open(name);
            const Mcap::Contents contents = Mcap::ReadContents(file);
            EXPECT_TRUE(contents.IsIndexed);
            Mcap::MessageCursor cursor(file, contents, {});
            while (const auto message = cursor.Next())
            {
                const Mcap::Channel &channel = contents.Channels.at(message->ChannelId);
                Recorded &topic = topics[channel.Topic];
                topic.Schema = contents.Schemas.at(channel.SchemaId).Name;
                topic.Kind = channel.Metadata.at("rabit.kind");
                const auto qos = channel.Metadata.find("rabit.qos");
                topic.Qos = qos == channel.Metadata.end() ? "" : qos->second;
                topic.Samples.emplace_back(message->Data.begin(), message->Data.end());
                topic.Sequences.push_back(message->Sequence);
                topic.LogTimes.push_back(message->LogTime);
                topic.PublishTimes.push_back(message->PublishTime);
            }
        }
        return topics;
    }

    static GatewayConfig Watching(const std::string &node)
    {
        GatewayConfig config = AircraftConfig(node);
        config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose", .From = {"uav*"}});
        return config;
    }

    static GatewayConfig Backfilling(const std::string &node)
    {
        GatewayConfig config = Watching(node);
        config.Record = RecordSettings{.Folder = "/recordings"};
        config.Record->Backfill = {"Pose"};
        return config;
    }

    SimulatedFleet Fleet{1};
    std::map<std::string, std::shared_ptr<FakeDisk>> Disks;
    std::map<std::string, RecorderManager *> Recorders;  // of nodes that run
    std::map<std::string, std::shared_ptr<GatewayTap>> Taps;
};

std::vector<std::uint32_t> NumbersOf(const Recorded &poses)
{
    std::vector<std::uint32_t> numbers;
    for (const Mcap::Bytes &sample : poses.Samples)
    {
        Uav::Pose pose;
        EXPECT_TRUE(MessageTypeRegistry::Find("Uav::Pose")->Deserialize(sample, pose));
        numbers.push_back(pose.number);
    }
    return numbers;
}

TEST_F(RecorderManagerTest, RecordsEachPostHereAndThoseThatComeFromOthers)
{
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    SimulatedNode &uav2 = Fleet.Add(AircraftConfig("uav2"));
    const auto own = uav1.Register<Uav::Pose>("Pose");
    const auto other = uav2.Register<Uav::Pose>("Pose");
    Fleet.RunFor(3s);
    for (std::uint32_t number = 1; number <= 5; ++number)
    {
        own->number = number;
        own->PostMessage();
        own->number = 10 * number;  // none is skipped, however quick
        own->PostMessage();
        other->number = 100 + number;
        other->PostMessage();
        Fleet.RunFor(200ms);
    }
    const auto topics = RecordingOf("uav1");
    const Recorded &posted = topics.at("uav1/Pose");
    EXPECT_EQ(posted.Schema, "Uav::Pose");
    EXPECT_EQ(posted.Kind, "posted");
    EXPECT_THAT(NumbersOf(posted), ElementsAre(1, 10, 2, 20, 3, 30, 4, 40, 5, 50));
    EXPECT_EQ(posted.LogTimes, posted.PublishTimes);
    const Recorded &mirrored = topics.at("uav2/Pose");
    EXPECT_EQ(mirrored.Kind, "mirrored");
    EXPECT_THAT(NumbersOf(mirrored), ElementsAre(101, 102, 103, 104, 105));
    for (std::size_t at = 0; at < mirrored.LogTimes.size(); ++at)
    {
        EXPECT_GE(mirrored.LogTimes[at], mirrored.PublishTimes[at]);
        EXPECT_LT(mirrored.LogTimes[at] - mirrored.PublishTimes[at], 300000000U);
    }
    EXPECT_EQ(topics.at("uav1/Gateway/Fleet").Schema, "Rabit::Gateway::Fleet");
}

// A program with its own main() may have no BackfillManager.
TEST_F(RecorderManagerTest, RecordsMessagesToBeBackfilledUnlessTheyAreTakenOver)
{
    AddRecorded(Backfilling("uav1"));
    AddRecorded(Backfilling("uav2"));
    Recorders.at("uav2")->Target()->TakeOver({"Pose"});
    const auto pose = Fleet.Add(AircraftConfig("uav3")).Register<Uav::Pose>("Pose");
    Fleet.RunFor(3s);
    pose->PostMessage();
    Fleet.RunFor(1s);
    EXPECT_TRUE(RecordingOf("uav1").contains("uav3/Pose"));
    EXPECT_FALSE(RecordingOf("uav2").contains("uav3/Pose")) << "another part records it";
}

TEST_F(RecorderManagerTest, TellsTheQosOfWhatTheConfigurationNames)
{
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    SimulatedNode &uav2 = Fleet.Add(AircraftConfig("uav2"));
    const auto pose = uav1.Register<Uav::Pose>("Pose");
    const auto mission = uav1.Register<Uav::MissionState>("MissionState");
    const auto own = uav1.Register<Uav::Goto>("Plan");
    const auto other = uav2.Register<Uav::Pose>("Pose");
    Fleet.RunFor(3s);
    pose->PostMessage();
    mission->PostMessage();
    own->PostMessage();
    other->PostMessage();
    Fleet.RunFor(1s);
    const auto topics = RecordingOf("uav1");
    EXPECT_EQ(topics.at("uav1/Pose").Qos, "telemetry");
    EXPECT_EQ(topics.at("uav1/MissionState").Qos, "state");
    EXPECT_EQ(topics.at("uav1/Plan").Qos, "none") << "it is not published";
    EXPECT_EQ(topics.at("uav2/Pose").Qos, "") << "the subscription names none";
}

TEST_F(RecorderManagerTest, RecordsQueueMessagesAtBothEndsWithTheirOutcome)
{
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    SimulatedNode &uav2 = AddRecorded(AircraftConfig("uav2"));
    IdleManager &control = uav2.AddIdleManager("MissionControl");
    Fleet.RunFor(3s);
    const auto command = std::make_shared<Uav::Goto>();
    command->altitude_m = 77;
    EXPECT_TRUE(
        uav1.Workspace.AddMessageToQueue("uav2/MissionControl", std::shared_ptr<RabitMessage>(command)));
    Fleet.RunFor(3s);
    EXPECT_GT(control.Passes, 0);
    const auto sender = RecordingOf("uav1");
    const Recorded &sent = sender.at("uav1/Recorder/sent/uav2/MissionControl/Uav::Goto");
    ASSERT_EQ(sent.Samples.size(), 1U);
    EXPECT_EQ(sent.Schema, "Uav::Goto");
    Uav::Goto read;
    EXPECT_TRUE(MessageTypeRegistry::Find("Uav::Goto")->Deserialize(sent.Samples[0], read));
    EXPECT_EQ(read.altitude_m, 77);
    const Recorded &outcomes = sender.at("uav1/Recorder/Outcomes");
    ASSERT_EQ(outcomes.Samples.size(), 1U);
    EXPECT_EQ(outcomes.JsonAt(0).at("outcome"), "delivered");
    EXPECT_EQ(outcomes.JsonAt(0).at("node"), "uav2");
    EXPECT_EQ(static_cast<std::uint32_t>(std::stoull(outcomes.JsonAt(0).at("id").get<std::string>())),
              sent.Sequences[0]);
    const Recorded received = RecordingOf("uav2").at("uav2/Recorder/received/uav1/MissionControl/Uav::Goto");
    EXPECT_EQ(received.Samples, sent.Samples);
}

TEST_F(RecorderManagerTest, RecordsEachSampleThatAForeignTopicPutsIntoAQueue)
{
    const ForeignRule rule{
        .Topic = "acks", .Type = "Uav::CommandAck", .Local = "Acks", .Each = ForeignRule::Delivery::Queue};
    const MessageType &type = Uav::CommandAck::IdlType();
    SimulatedNode &uav1 = AddRecorded(AircraftConfig("uav1"));
    uav1.AddIdleManager("Acks");
    // All programs on the simulated network are nodes.
    Foreign::Network network;
    Foreign::Session session(network);
    ForeignReader reader(
        rule, type, {}, uav1.Workspace, [] {}, nullptr, Taps.at("uav1"));
    reader.Open(session, 0s);
    Uav::CommandAck ack;
    for (std::uint32_t number = 1; number <= 3; ++number)
    {
        ack.id = number;
        network.Deliver(type, ack, number);
    }
    reader.Service(0s);
    const Recorded received = RecordingOf("uav1").at("uav1/Recorder/received/(foreign)/Acks/Uav::CommandAck");
    EXPECT_EQ(received.Kind, "queue received");
    ASSERT_EQ(received.Samples.size(), 3U);
    EXPECT_TRUE(type.Deserialize(received.Samples[2], ack));
    EXPECT_EQ(ack.id, 3U);
}

TEST_F(RecorderManagerTest, RecordsEachMessageOfAQueueThatIsWrittenToAForeignTopic)
{
    GatewayConfig config = AircraftConfig("uav1");
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "goals",
                              .Type = "Uav::Goto",
                              .Local = "Goals",
                              .Each = ForeignRule::Delivery::Queue,
                              .Capacity = 2});
    const PlainProgram program(Fleet.Network, "goals", "Uav::Goto");
    SimulatedNode &uav1 = AddRecorded(config);
    Fleet.RunFor(3s);
    const auto goal = std::make_shared<Uav::Goto>();
    EXPECT_TRUE(uav1.Workspace.AddMessageToQueue("Goals", goal));
    EXPECT_TRUE(uav1.Workspace.AddMessageToQueue("Goals", goal));
    EXPECT_FALSE(uav1.Workspace.AddMessageToQueue("Goals", goal));
    Fleet.RunFor(3s);
    EXPECT_EQ(program.Samples.size(), 2U);
    const auto topics = RecordingOf("uav1");
    const Recorded &sent = topics.at("uav1/Recorder/sent/(foreign)/Goals/Uav::Goto");
    EXPECT_EQ(sent.Samples.size(), 2U);
    EXPECT_EQ(sent.Kind, "queue sent");
    EXPECT_EQ(topics.at("uav1/Recorder/refused/(foreign)/Goals/Uav::Goto").Samples.size(), 1U);
    const Recorded &outcomes = topics.at("uav1/Recorder/Outcomes");
    ASSERT_EQ(outcomes.Samples.size(), 3U);
    EXPECT_EQ(outcomes.JsonAt(0).at("outcome"), "refused");
    EXPECT_EQ(outcomes.JsonAt(0).at("node"), "(foreign)");
    EXPECT_EQ(outcomes.JsonAt(1).at("outcome"), "delivered");
    EXPECT_EQ(outcomes.JsonAt(1).at("queue"), "Goals");
    EXPECT_EQ(static_cast<std::uint32_t>(std::stoull(outcomes.JsonAt(2).at("id").get<std::string>())),
              sent.Sequences[1]);
}

TEST_F(RecorderManagerTest, RecordsWhatIsRefusedAtTheCallAndWhy)
{
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    Fleet.RunFor(1s);
    EXPECT_FALSE(uav1.Workspace.AddMessageToQueue(
        "uav9/MissionControl", std::shared_ptr<RabitMessage>(std::make_shared<Uav::Goto>())));
    const auto topics = RecordingOf("uav1");
    EXPECT_EQ(topics.count("uav1/Recorder/refused/uav9/MissionControl/Uav::Goto"), 1U);
    const Json outcome = topics.at("uav1/Recorder/Outcomes").JsonAt(0);
    EXPECT_EQ(outcome.at("outcome"), "refused");
    EXPECT_THAT(outcome.at("reason").get<std::string>(), HasSubstr("uav9"));
}

TEST_F(RecorderManagerTest, RecordsWhichLimitAMessageExceeded)
{
    GatewayConfig config = Watching("uav1");
    config.Send.push_back({.To = "*", .CapacityBytes = 1});
    SimulatedNode &uav1 = AddRecorded(config);
    Fleet.Add(AircraftConfig("uav2")).AddIdleManager("MissionControl");
    Fleet.RunFor(3s);
    EXPECT_FALSE(uav1.Workspace.AddMessageToQueue("uav2/MissionControl", std::make_shared<Uav::Goto>()));
    const Recorded outcomes = RecordingOf("uav1").at("uav1/Recorder/Outcomes");
    EXPECT_EQ(outcomes.JsonAt(0).at("reason"), "larger than the outbox");
}

TEST_F(RecorderManagerTest, RecordsManagersClocksAndTheLog)
{
    AddRecorded(Watching("uav1"));
    Fleet.Add(AircraftConfig("uav2"));
    Fleet.RunFor(5s);
    RabitLog::Write(RabitLogLevel::Warning, "the wind is strong");
    Fleet.RunFor(1s);
    const auto topics = RecordingOf("uav1");
    std::set<std::string> managers;
    for (std::size_t at = 0; at < topics.at("uav1/Recorder/Managers").Samples.size(); ++at)
    {
        managers.insert(topics.at("uav1/Recorder/Managers").JsonAt(at).at("manager").get<std::string>());
    }
    EXPECT_THAT(managers, ElementsAre("Gateway", "Recorder"));
    const Recorded &log = topics.at("uav1/Recorder/Log");
    EXPECT_EQ(log.Schema, "foxglove.Log");
    EXPECT_EQ(log.JsonAt(log.Samples.size() - 1).at("message"), "the wind is strong");
    EXPECT_EQ(log.JsonAt(log.Samples.size() - 1).at("level"), 3);
    const Recorded &clocks = topics.at("uav1/Recorder/Clocks");
    const Json last = clocks.JsonAt(clocks.Samples.size() - 1);
    ASSERT_EQ(last.at("peers").size(), 1U);
    EXPECT_EQ(last.at("peers")[0].at("node"), "uav2");
    EXPECT_GE(last.at("peers")[0].at("uncertain_by_ns").get<std::int64_t>(), 0);
}

TEST_F(RecorderManagerTest, LeavesOutWhatItIsTold)
{
    GatewayConfig config = Watching("uav1");
    config.Record =
        RecordSettings{.Folder = "/recordings", .Messages = {"*"}, .Except = {"Mission*"}, .Queues = false};
    SimulatedNode &uav1 = AddRecorded(config);
    uav1.Register<Uav::Pose>("Pose")->PostMessage();
    uav1.Register<Uav::MissionState>("MissionState")->PostMessage();
    Fleet.RunFor(1s);
    uav1.Workspace.AddMessageToQueue("uav9/MissionControl",
                                     std::shared_ptr<RabitMessage>(std::make_shared<Uav::Goto>()));
    const auto topics = RecordingOf("uav1");
    EXPECT_EQ(topics.count("uav1/Pose"), 1U);
    EXPECT_EQ(topics.count("uav1/MissionState"), 0U);
    EXPECT_EQ(topics.count("uav1/Recorder/Outcomes"), 0U);
}

TEST_F(RecorderManagerTest, SaysInTheFleetThatNothingIsRecorded)
{
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    Disks.at("uav1")->CreateFails = "/recordings/x: Permission denied";
    uav1.Register<Uav::Pose>("Pose")->PostMessage();
    // The recorder's own thread is not under simulated time.
    const auto isTold = [&]
    {
        Fleet.RunFor(1s);
        return uav1.Problems().find("record uav1/Pose: ") != std::string::npos;
    };
    EXPECT_TRUE(RabitTest::Eventually(isTold));
    EXPECT_THAT(uav1.Problems(),
                HasSubstr("record: nothing is recorded: /recordings/x: Permission denied\n"));
    EXPECT_THAT(uav1.Problems(), HasSubstr("record uav1/Pose: 1 messages were not recorded\n"));
}

TEST_F(RecorderManagerTest, SaysInTheFileWhoWasRecordedAndWhatCouldNotBe)
{
    class Plain : public RabitMessage
    {
    public:
        std::unique_ptr<RabitMessage> Clone() const override { return std::make_unique<Plain>(*this); }
    };
    SimulatedNode &uav1 = AddRecorded(Watching("uav1"));
    uav1.Register<Plain>("Plain");
    Fleet.RunFor(1s);
    Fleet.Stop("uav1");
    const MemoryFile file = Disks.at("uav1")->Open(Disks.at("uav1")->Names().at(0));
    EXPECT_EQ(MetadataOf(file, "rabit.node").at("node"), "uav1");
    const auto notRecorded = MetadataOf(file, "rabit.not_recorded");
    ASSERT_EQ(notRecorded.size(), 1u) << "messages that control managers are no data";
    EXPECT_EQ(notRecorded.at("Plain"), "its type was not made from IDL");
}

TEST_F(RecorderManagerTest, SaysInTheFileThatQueueMessagesAreNotRecorded)
{
    GatewayConfig config = Watching("uav1");
    config.Record = RecordSettings{.Folder = "/recordings"};
    config.Record->Queues = false;
    AddRecorded(config);
    Fleet.RunFor(1s);
    Fleet.Stop("uav1");
    const MemoryFile file = Disks.at("uav1")->Open(Disks.at("uav1")->Names().at(0));
    EXPECT_EQ(MetadataOf(file, "rabit.not_recorded").at("queue messages"), "`record: queues` is off");
}

TEST_F(RecorderManagerTest, WritesABlackBoxWhenACommandIsRefused)
{
    GatewayConfig config = Watching("uav1");
    config.Record = RecordSettings{.Folder = "/recordings"};
    config.Record->BlackBox = BlackBoxSettings{.Before = 10s, .After = 5s};
    SimulatedNode &uav1 = AddRecorded(config);
    const auto state = uav1.Register<Uav::MissionState>("MissionState");
    state->poses = 7;
    state->PostMessage();
    const auto pose = uav1.Register<Uav::Pose>("Pose");
    for (std::uint32_t second = 1; second <= 30; ++second)
    {
        pose->number = second;
        pose->PostMessage();
        Fleet.RunFor(1s);
    }
    EXPECT_TRUE(Disks.at("uav1")->Names().empty());
    uav1.Workspace.AddMessageToQueue("uav9/MissionControl",
                                     std::shared_ptr<RabitMessage>(std::make_shared<Uav::Goto>()));
    Fleet.RunFor(1s);
    const auto topics = RecordingOf("uav1");
    EXPECT_EQ(NumbersOf(topics.at("uav1/Pose")).back(), 30U);
    EXPECT_GE(NumbersOf(topics.at("uav1/Pose")).front(), 20U) << "what is older is let go of";
    EXPECT_EQ(topics.at("uav1/Recorder/Events").JsonAt(0).at("event"),
              "refused: a message for uav9/MissionControl");
    // The State is in the recording, however long ago it was posted.
    Uav::MissionState read;
    ASSERT_TRUE(MessageTypeRegistry::Find("Uav::MissionState")
                    ->Deserialize(topics.at("uav1/MissionState").Samples.at(0), read));
    EXPECT_EQ(read.poses, 7U);
}

TEST_F(RecorderManagerTest, WritesABlackBoxForMessagesQueuesProblemsAndByHand)
{
    GatewayConfig config = Watching("uav1");
    config.Record = RecordSettings{.Folder = "/recordings"};
    config.Record->BlackBox = BlackBoxSettings{
        .Messages = {"Mission*"}, .Queues = {"MissionControl"}, .Outcomes = false, .Problems = true};
    SimulatedNode &uav1 = AddRecorded(config);
    SimulatedNode &uav2 = Fleet.Add(AircraftConfig("uav2"));
    uav1.AddIdleManager("MissionControl");
    Fleet.RunFor(3s);
    uav1.Register<Uav::MissionState>("MissionState")->PostMessage();
    uav2.Workspace.AddMessageToQueue("uav1/MissionControl",
                                     std::shared_ptr<RabitMessage>(std::make_shared<Uav::Goto>()));
    Fleet.RunFor(5s);
    Recorders.at("uav1")->WriteBlackBox("by hand");
    Fleet.RunFor(1s);
    const auto topics = RecordingOf("uav1");
    std::string events;
    for (std::size_t at = 0; at < topics.at("uav1/Recorder/Events").Samples.size(); ++at)
    {
        events += topics.at("uav1/Recorder/Events").JsonAt(at).at("event").get<std::string>() + "\n";
    }
    EXPECT_THAT(events, HasSubstr("message uav1/MissionState\n"));
    EXPECT_THAT(events, HasSubstr("Uav::Goto of uav2 in MissionControl\n"));
    EXPECT_THAT(events, HasSubstr("by hand\n"));
    EXPECT_THAT(events, HasSubstr("problem "));
}

TEST(RecorderManager, NeedsToBeToldWhatToRecord)
{
    GatewayConfig config = AircraftConfig("uav1");
    EXPECT_THROW(RecorderManager manager(config), std::invalid_argument);
}

}  // namespace
}  // namespace Rabit
