#include "recording/merge/Merger.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

#include "SyntheticFleet.h"

namespace Rabit::Merge
{
namespace
{

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Key;
using testing::Not;
using Time = SyntheticFleet::Time;
using Json = nlohmann::json;

constexpr Time Ms = 1000000;
constexpr Time Minute = 60 * OneSecond;

SyntheticFleet::Spec Node(const std::string &name, Time end, Time wallAhead = 0)
{
    SyntheticFleet::Spec spec;
    spec.Name = name;
    spec.End = end;
    spec.WallAhead = wallAhead;
    return spec;
}

std::optional<Time> Quick(std::size_t, std::size_t, Time, std::mt19937 &random)
{
    return std::uniform_int_distribution<Time>(Ms, 3 * Ms)(random);
}

struct Read
{
    Mcap::Channel Channel;
    std::uint64_t LogTime = 0;
    std::uint64_t PublishTime = 0;
    Mcap::Bytes Data;
};

struct MergedFile
{
    MergedFile(const SyntheticFleet &fleet, const std::vector<std::string> &paths,
               const MergeWishes &wishes = {})
        : Opener(fleet.Opener()), All(ReadLives(Opener, paths)), Plan(MakePlan(All, wishes))
    {
        EXPECT_EQ(All.Problem, "");
        EXPECT_EQ(Plan.Problem, "");
        Mcap::McapWriter writer(File, {"test", "rabit", true});
        Result = Merger(Opener, All, Plan, writer).Run([] { return false; });
        Contents = Mcap::ReadContents(File);
        Mcap::MessageCursor cursor(File, Contents, {});
        while (const auto message = cursor.Next())
        {
            Messages.push_back({Contents.Channels.at(message->ChannelId),
                                message->LogTime,
                                message->PublishTime,
                                {message->Data.begin(), message->Data.end()}});
        }
    }
    std::vector<Read> Of(const std::string &topic) const
    {
        std::vector<Read> found;
        for (const Read &message : Messages)
        {
            if (message.Channel.Topic == topic)
            {
                found.push_back(message);
            }
        }
        return found;
    }
    Mcap::TextMap Recording(const std::string &node, const std::string &life = "1") const
    {
        for (const Mcap::Metadata &metadata : Contents.MetadataRecords)
        {
            if (metadata.Name == "rabit.recording" && metadata.Values.at("node") == node &&
                metadata.Values.at("life") == life)
            {
                return metadata.Values;
            }
        }
        return {};
    }

    const OpenFile Opener;
    const Lives All;
    const MergePlan Plan;
    MemoryFile File;
    Merged Result;
    Mcap::Contents Contents;
    std::vector<Read> Messages;
};

TEST(Merger, TellsWhatANodeKnewFromWhatWasPosted)
{
    const SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute, 5 * Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths());
    EXPECT_TRUE(merged.Result.IsWritten);
    const auto posted = merged.Of("uav2/Pose");
    const auto knew = merged.Of("uav1/Recorder/knew/uav2/Pose");
    ASSERT_GT(posted.size(), 200U);
    ASSERT_GT(knew.size(), 200U);
    EXPECT_EQ(posted[0].Channel.Metadata.at("rabit.kind"), "posted");
    EXPECT_EQ(posted[0].Channel.Metadata.at("rabit.recorded_by"), "uav2");
    const Mcap::TextMap &metadata = knew[0].Channel.Metadata;
    EXPECT_EQ(metadata.at("rabit.kind"), "knew");
    EXPECT_EQ(metadata.at("rabit.recorded_by"), "uav1");
    EXPECT_EQ(metadata.at("rabit.node"), "uav2");
    EXPECT_EQ(metadata.at("rabit.message"), "Pose");
}

TEST(Merger, PutsBothTimesOfAMessageOnTheTimeLine)
{
    const SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute, 5 * Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths(), {"uav1"});
    const Time bound = *merged.Plan.WorstBound();
    for (const Read &message : merged.Of("uav2/Pose"))
    {
        const auto expected = static_cast<double>(fleet.LogAt(0, SyntheticFleet::PostedOf(message.Data)));
        ASSERT_NEAR(static_cast<double>(message.LogTime), expected, static_cast<double>(bound));
        ASSERT_NEAR(static_cast<double>(message.PublishTime), expected, static_cast<double>(bound));
    }
    // A mirrored post came after it was posted.
    for (const Read &message : merged.Of("uav2/Recorder/knew/uav1/Pose"))
    {
        const auto expected = static_cast<double>(fleet.LogAt(0, SyntheticFleet::PostedOf(message.Data)));
        ASSERT_NEAR(static_cast<double>(message.PublishTime), expected, static_cast<double>(2 * bound));
        ASSERT_GT(message.LogTime, message.PublishTime);
    }
}

TEST(Merger, WritesInTheOrderOfTheTimeLine)
{
    const SyntheticFleet fleet(
        {Node("uav1", Minute), Node("uav2", Minute, 5 * Minute), Node("uav3", Minute, -Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths());
    // Checks the order in the file itself, not in its index.
    std::uint64_t last = 0;
    for (const Mcap::ChunkIndex &chunk : merged.Contents.Chunks)
    {
        EXPECT_GE(chunk.StartTime, last);
        last = chunk.EndTime;
    }
    EXPECT_GT(last, 0U);
}

TEST(Merger, JoinsTheFilesOfARecordingWithoutWhatTheyRepeat)
{
    auto split = Node("uav1", 2 * Minute, Minute);
    split.SplitEvery = 10 * OneSecond;
    const SyntheticFleet fleet({split, Node("uav2", 2 * Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths());
    EXPECT_EQ(merged.All.All.size(), 2U);
    EXPECT_EQ(merged.Result.Repeated, 22U);  // of two states, in 11 files
    for (const char *topic : {"uav1/Pose", "uav1/Recorder/knew/uav2/Pose"})
    {
        std::set<Time> once;
        for (const Read &message : merged.Of(topic))
        {
            EXPECT_TRUE(once.insert(SyntheticFleet::PostedOf(message.Data)).second) << topic;
        }
    }
    EXPECT_THAT(merged.Recording("uav1").at("files"), HasSubstr("uav1_1_2.mcap\n"));
}

TEST(Merger, KeepsTheStatesOfAFileWhoseFormerOnesAreMissing)
{
    auto split = Node("uav1", Minute, Minute);
    split.SplitEvery = 20 * OneSecond;
    const SyntheticFleet fleet({split, Node("uav2", Minute)}, Quick);
    const MergedFile merged(fleet, {"uav1_1_3.mcap", "uav2_1_1.mcap"});
    EXPECT_EQ(merged.Result.Repeated, 0U);
}

TEST(Merger, GivesEachLifeChannelsOfItsOwn)
{
    auto second = Node("uav1", 2 * Minute, 9 * Minute);
    second.Begin = Minute + 5 * OneSecond;
    second.Incarnation = 2;
    const SyntheticFleet fleet({Node("ground", 2 * Minute), Node("uav1", Minute), second}, Quick);
    const MergedFile merged(fleet, fleet.Paths(), {"ground"});
    std::uint64_t last = 0;
    std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> spans;
    for (const Read &message : merged.Of("uav1/Pose"))
    {
        EXPECT_GE(message.LogTime, last);
        last = message.LogTime;
        auto &span = spans.try_emplace(message.Channel.Metadata.at("rabit.life"), last, last).first->second;
        span.second = last;
    }
    ASSERT_EQ(spans.size(), 2U);
    EXPECT_LT(spans["1"].second, spans["2"].first);
    EXPECT_EQ(merged.Recording("uav1", "2").at("incarnation"), "2");
    const auto isPose = [](const auto &schema) { return schema.second.Name == "Test::Pose"; };
    EXPECT_EQ(std::count_if(merged.Contents.Schemas.begin(), merged.Contents.Schemas.end(), isPose), 1)
        << "the lives wrote one definition in two ways";
}

TEST(Merger, StatesTheBoundOfTheError)
{
    const SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute, 5 * Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths(), {"uav1"});
    const Mcap::TextMap all = MetadataOf(merged.Contents, "rabit.merge");
    EXPECT_EQ(all.at("time_line"), "uav1");
    EXPECT_EQ(all.at("uncertain_by_ns"), std::to_string(*merged.Plan.WorstBound()));
    const Mcap::TextMap recording = merged.Recording("uav2");
    EXPECT_EQ(recording.at("clock"), "relations");
    EXPECT_EQ(recording.at("uncertain_by_ns"), std::to_string(*merged.Plan.WorstBound()));
    EXPECT_EQ(merged.Recording("uav1").at("uncertain_by_ns"), "0");
    const auto told = merged.Of("uav2/Recorder/TimeLine");
    EXPECT_GE(told.size(), 5U);
    const Json json = Json::parse(told[1].Data);
    EXPECT_EQ(json.at("clock"), "relations");
    EXPECT_LT(json.at("uncertain_by_ns").get<Time>(), 10 * Ms);
    EXPECT_NEAR(std::stod(json.at("later_by_ns").get<std::string>()), -5.0 * Minute, 10.0 * Ms);
}

TEST(Merger, SaysOfAWallClockThatNothingIsKnown)
{
    const SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute, 5 * Minute)},
                               [](std::size_t, std::size_t, Time, std::mt19937 &) { return std::nullopt; });
    const MergedFile merged(fleet, fleet.Paths(), {"uav1", true});
    EXPECT_EQ(merged.Recording("uav2").at("clock"), "wall clock");
    EXPECT_EQ(merged.Recording("uav2").at("uncertain_by_ns"), "not known");
    EXPECT_EQ(MetadataOf(merged.Contents, "rabit.merge").at("uncertain_by_ns"), "not known");
    EXPECT_TRUE(Json::parse(merged.Of("uav2/Recorder/TimeLine")[0].Data).at("uncertain_by_ns").is_null());
}

TEST(Merger, KeepsReportsOfClocksTrue)
{
    const SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute, 5 * Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths(), {"uav1"});
    const auto told = merged.Of("uav2/Recorder/Clocks");
    const auto report = ReadClockReport(told.back().Data);
    // The clock of uav1, as uav2 knew it, on a time line that is the clock of uav1.
    ASSERT_EQ(report->Peers.size(), 1U);
    const Life &uav1 = merged.All.All[0];
    EXPECT_NEAR(static_cast<double>(report->Peers[0].SourceToLog), static_cast<double>(uav1.SourceToLog),
                10.0 * Ms);
}

TEST(Merger, PutsLogLinesOnTheTimeLine)
{
    const std::vector<std::string> paths = {"uav1.mcap"};
    SyntheticFleet fleet({Node("uav0", Minute)}, Quick);
    const auto file = std::make_shared<MemoryFile>();
    {
        Mcap::McapWriter writer(*file, {"test", "rabit", true});
        writer.AddMetadata({"rabit.node", {{"node", "uav1"}}});
        const std::uint16_t channel = *writer.AddChannel(writer.AddSchema("foxglove.Log", "jsonschema", "{}"),
                                                         "uav1/Recorder/Log", "json");
        const std::string line = R"({"timestamp":{"sec":7,"nsec":5},"message":"hello"})";
        const std::string garbage = R"({"timestamp":{"sec":"x"}})";
        writer.Add({channel, 0, 7000000005U, 7000000005U, Mcap::Bytes(line.begin(), line.end())});
        writer.Add({channel, 0, 7000000006U, 7000000006U, Mcap::Bytes(garbage.begin(), garbage.end())});
        writer.Finish();
    }
    fleet.Files["uav1.mcap"] = file;
    const MergedFile merged(fleet, fleet.Paths(), {"uav0", true});
    const auto lines = merged.Of("uav1/Recorder/Log");
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(Json::parse(lines[0].Data),
              Json::parse(R"({"timestamp":{"sec":7,"nsec":5},"message":"hello"})"));
}

TEST(Merger, TakesWhatIsThereOfAFileThatWasCutOffAnywhere)
{
    SyntheticFleet fleet({Node("uav1", 3 * OneSecond), Node("uav2", 3 * OneSecond, 5 * Minute)}, Quick);
    const Mcap::Bytes whole = fleet.Files["uav2_1_1.mcap"]->Content;
    std::uint64_t most = 0;
    for (std::size_t size = 0; size < whole.size(); size += 7)
    {
        fleet.Files["uav2_1_1.mcap"]->Content.assign(whole.begin(),
                                                     whole.begin() + static_cast<std::ptrdiff_t>(size));
        const MergedFile merged(fleet, fleet.Paths(), {"uav1", true});
        ASSERT_TRUE(merged.Result.IsWritten);
        ASSERT_TRUE(merged.Contents.Problems.empty());
        most = std::max(most, merged.Contents.Statistics.MessageCount);
    }
    fleet.Files["uav2_1_1.mcap"]->Content = whole;
    EXPECT_EQ(MergedFile(fleet, fleet.Paths(), {"uav1", true}).Contents.Statistics.MessageCount, most);
}

TEST(Merger, HoldsWhateverByteIsDamaged)
{
    SyntheticFleet fleet({Node("uav1", 2 * OneSecond), Node("uav2", 2 * OneSecond, 5 * Minute)}, Quick);
    const Mcap::Bytes whole = fleet.Files["uav2_1_1.mcap"]->Content;
    for (std::size_t at = 0; at < whole.size(); at += 3)
    {
        Mcap::Bytes damaged = whole;
        damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ (1U << (at % 8)));
        fleet.Files["uav2_1_1.mcap"]->Content = damaged;
        const Lives lives = ReadLives(fleet.Opener(), fleet.Paths());
        const MergePlan plan = MakePlan(lives, {"uav1", true});
        if (lives.Problem.empty() && plan.Problem.empty())
        {
            MemoryFile file;
            Mcap::McapWriter writer(file, {"test", "rabit", true});
            EXPECT_TRUE(Merger(fleet.Opener(), lives, plan, writer).Run([] { return false; }).IsWritten);
        }
    }
}

TEST(Merger, TakesAFileAndItsRecoveredCopyOnce)
{
    SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute)}, Quick);
    fleet.Files["uav1_1_1_recovered.mcap"] =
        std::make_shared<MemoryFile>(fleet.Files["uav1_1_1.mcap"]->Content);
    const Mcap::Bytes &whole = fleet.Files["uav1_1_1.mcap"]->Content;
    fleet.Files["uav1_1_1.mcap"]->Content.resize(whole.size() / 2);
    const Lives lives = ReadLives(fleet.Opener(), fleet.Paths());
    ASSERT_EQ(lives.All.size(), 2U);
    ASSERT_EQ(lives.All[0].Files.size(), 1U);
    EXPECT_EQ(lives.All[0].Files[0].Path, "uav1_1_1_recovered.mcap");
    EXPECT_THAT(lives.Remarks.back(), HasSubstr("uav1_1_1.mcap: is passed over"));
}

TEST(Merger, RefusesWhatIsMergedAlready)
{
    SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute)}, Quick);
    const MergedFile merged(fleet, fleet.Paths());
    fleet.Files["flight.mcap"] = std::make_shared<MemoryFile>(merged.File.Content);
    EXPECT_EQ(ReadLives(fleet.Opener(), fleet.Paths()).Problem, "flight.mcap: is merged already");
}

TEST(Merger, RefusesAFileThatDoesNotSayWhoseItIs)
{
    SyntheticFleet fleet({Node("uav1", Minute)}, Quick);
    const auto file = std::make_shared<MemoryFile>();
    Mcap::McapWriter writer(*file, {"somebody", "", true});
    writer.Add({*writer.AddChannel(0, "topic", "json"), 0, 5, 5, Mcap::Bytes{1}});
    writer.Finish();
    fleet.Files["other.mcap"] = file;
    EXPECT_EQ(ReadLives(fleet.Opener(), fleet.Paths()).Problem,
              "other.mcap: does not say which node recorded it");
}

TEST(Merger, AddsUpWhatWasLost)
{
    SyntheticFleet fleet({Node("uav1", Minute), Node("uav2", Minute)}, Quick);
    for (const auto &[path, pose] : {std::pair("a.mcap", "uav1/Pose"), std::pair("b.mcap", "uav2/Pose")})
    {
        const auto file = std::make_shared<MemoryFile>();
        Mcap::McapWriter writer(*file, {"test", "rabit", true});
        writer.AddMetadata({"rabit.node", {{"node", "uav9"}}});
        const bool isFirst = std::string(path) == "a.mcap";
        writer.AddMetadata(
            {"rabit.file", {{"node", "uav9"}, {"number", isFirst ? "1" : "2"}, {"recording", "uav9"}}});
        const std::uint16_t channel =
            *writer.AddChannel(0, pose, "cdr", {{"rabit.kind", "mirrored"}, {"rabit.node", "uav1"}});
        writer.Add({channel, 0, isFirst ? 5U : 6U, 5, Mcap::Bytes{1}});
        writer.AddMetadata({"rabit.losses", {{"uav1/Pose", isFirst ? "4" : "7"}, {"uav9/Health", "2"}}});
        writer.Finish();
        fleet.Files[path] = file;
    }
    const MergedFile merged(fleet, fleet.Paths(), {"uav1", true});
    const Mcap::TextMap losses = MetadataOf(merged.Contents, "rabit.losses");
    EXPECT_EQ(losses, (Mcap::TextMap{{"uav9/Health", "2"}, {"uav9/Recorder/knew/uav1/Pose", "7"}}));
}

TEST(Merger, EndsWhenItIsToldToOrTheDiskIsFull)
{
    const SyntheticFleet fleet({Node("uav1", 3 * Minute), Node("uav2", 3 * Minute)}, Quick);
    const OpenFile opener = fleet.Opener();
    const Lives lives = ReadLives(opener, fleet.Paths());
    const MergePlan plan = MakePlan(lives, {});
    MemoryFile stopped;
    Mcap::McapWriter one(stopped, {"test", "rabit", true});
    EXPECT_TRUE(Merger(opener, lives, plan, one).Run([] { return true; }).WasStopped);
    MemoryFile full;
    full.Room = 5000;
    Mcap::McapWriter other(full, {"test", "rabit", true});
    EXPECT_FALSE(Merger(opener, lives, plan, other).Run([] { return false; }).IsWritten);
}

}  // namespace
}  // namespace Rabit::Merge
