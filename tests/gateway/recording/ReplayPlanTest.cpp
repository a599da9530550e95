#include "recording/replay/ReplayPlan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "PlayedFile.h"

namespace Rabit::Replay
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class ReplayPlanTest : public ::testing::Test
{
protected:
    PlayedFile &AddFile(const std::string &recorder, const PlayedFile::TextMap &more = {})
    {
        return files.emplace_back(recorder, more);
    }
    ReplayPlan Plan(const PlanSettings &settings = {})
    {
        std::vector<const Mcap::Contents *> contents;
        for (PlayedFile &file : files)
        {
            contents.push_back(&file.Contents());
        }
        return PlanReplay(contents, settings);
    }
    // Returns NODE/MESSAGE<RECORDER, NODE>PEER/QUEUE, or NODE! for each stream.
    static std::vector<std::string> NamesOf(const ReplayPlan &plan)
    {
        std::vector<std::string> names;
        for (const ReplayStream &stream : plan.Streams)
        {
            const bool isQueue = stream.What == ReplayStream::Kind::Queue;
            names.push_back(stream.What == ReplayStream::Kind::Fleet ? stream.Node + "!"
                            : isQueue ? stream.Node + ">" + stream.Peer + "/" + stream.Name
                                      : stream.Node + "/" + stream.Name + "<" + stream.Recorder);
        }
        return names;
    }

    std::deque<PlayedFile> files;
};

TEST_F(ReplayPlanTest, WhatANodePublishedAndWhatItHadFromOthersIsPlayed)
{
    PlayedFile &file = AddFile("uav1", {{"domain", "7"}});
    file.Posted("uav1", "Pose", "telemetry");
    file.Posted("uav1", "MissionState", "state");
    file.Mirrored("uav2", "Pose");
    file.Fleet("uav1");
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan),
                UnorderedElementsAre("uav1/Pose<uav1", "uav1/MissionState<uav1", "uav2/Pose<uav1", "uav1!"));
    EXPECT_THAT(plan.Nodes, ElementsAre("uav1", "uav2"));
    EXPECT_THAT(plan.Domains, ElementsAre("7"));
    EXPECT_EQ(plan.Streams.at(0).Qos, "telemetry");
    EXPECT_EQ(plan.Streams.at(1).Qos, "state");
    EXPECT_EQ(plan.Streams.at(0).Type, "Uav::Pose");
    EXPECT_EQ(plan.Streams.at(0).IdlText, "text");
}

TEST_F(ReplayPlanTest, RecordingsBeforeAndAfterNamesLostTheirUnderscoreAreOneStream)
{
    for (const std::string text : {"struct _String { long x; };", "struct String { long x; };"})
    {
        AddFile("uav1").Channel("uav1/Name", {{"rabit.kind", "posted"}, {"rabit.node", "uav1"}}, "String",
                                "cdr", text);
    }
    const ReplayPlan plan = Plan();
    ASSERT_EQ(plan.Streams.size(), 1U);
    EXPECT_EQ(plan.Streams[0].IdlText, "struct String { long x; };");
    EXPECT_EQ(plan.Channels[0].size(), 1U);
    EXPECT_EQ(plan.Channels[1].size(), 1U);
}

TEST_F(ReplayPlanTest, PostsThatCameLaterArePlayedWithThoseThatCameLive)
{
    PlayedFile &file = AddFile("ground");
    file.Mirrored("uav1", "Pose");
    file.Channel("uav1/Pose", {{"rabit.kind", "backfilled"}, {"rabit.node", "uav1"}});
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), ElementsAre("uav1/Pose<ground"));
    EXPECT_EQ(plan.Channels[0].size(), 2U);
}

TEST_F(ReplayPlanTest, PostsThatCameLaterArePlayedFromAMergedRecording)
{
    PlayedFile &file = AddFile("");
    const PlayedFile::TextMap common = {
        {"rabit.node", "uav1"}, {"rabit.message", "Pose"}, {"rabit.recorded_by", "ground"}};
    PlayedFile::TextMap knew = common;
    knew["rabit.kind"] = "knew";
    PlayedFile::TextMap backfilled = common;
    backfilled["rabit.kind"] = "backfilled";
    file.Channel("ground/Recorder/knew/uav1/Pose", knew);
    file.Channel("ground/Recorder/backfilled/uav1/Pose", backfilled);
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), ElementsAre("uav1/Pose<ground"));
    EXPECT_EQ(plan.Channels[0].size(), 2U);
}

TEST_F(ReplayPlanTest, WhatANodeKeptToItselfIsPlayedIfItIsNamed)
{
    AddFile("uav1").Posted("uav1", "Plan", "none");
    EXPECT_THAT(NamesOf(Plan()), IsEmpty());
    EXPECT_THAT(NamesOf(Plan({.Include = {"uav1/Plan"}})), ElementsAre("uav1/Plan<uav1"));
}

TEST_F(ReplayPlanTest, PatternsSayWhatIsPlayedAndWhatIsNot)
{
    PlayedFile &file = AddFile("uav1");
    file.Posted("uav1", "Pose");
    file.Posted("uav1", "CameraView");
    file.Mirrored("uav2", "Pose");
    EXPECT_THAT(NamesOf(Plan({.Exclude = {"*/CameraView"}})),
                UnorderedElementsAre("uav1/Pose<uav1", "uav2/Pose<uav1"));
    const ReplayPlan one = Plan({.Include = {"uav2/*"}, .Exclude = {"*/CameraView"}});
    EXPECT_THAT(NamesOf(one), ElementsAre("uav2/Pose<uav1"));
    EXPECT_THAT(one.Nodes, ElementsAre("uav2"));
    EXPECT_THAT(Plan({.Exclude = {"uav1/*"}}).Nodes, ElementsAre("uav2"));
}

TEST_F(ReplayPlanTest, ANodeThatPostedNothingWasThereAllTheSame)
{
    AddFile("ground").Fleet("ground");
    EXPECT_THAT(Plan().Nodes, ElementsAre("ground"));
}

TEST_F(ReplayPlanTest, ARecordingFromOutsideAddsNoNode)
{
    PlayedFile &file = AddFile("rabit.vm.7", {{"kind", "rabit record"}});
    file.Mirrored("uav1", "Pose");
    file.Fleet("rabit.vm.7");
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), UnorderedElementsAre("uav1/Pose<rabit.vm.7", "rabit.vm.7!"));
    EXPECT_THAT(plan.Nodes, ElementsAre("uav1"));
}

TEST_F(ReplayPlanTest, OfWhatSeveralRecordedThatOfItsOwnNodeIsPlayed)
{
    PlayedFile &ground = AddFile("ground");
    const std::uint16_t mirrored = ground.Mirrored("uav1", "Pose");
    ground.Add(mirrored, 1, 1);
    ground.Add(mirrored, 2, 2);
    PlayedFile &own = AddFile("uav1");
    own.Add(own.Posted("uav1", "Pose"), 1, 1);
    EXPECT_THAT(NamesOf(Plan()), ElementsAre("uav1/Pose<uav1"));
}

TEST_F(ReplayPlanTest, ARecordingThatIsWholeLacksNothing)
{
    PlayedFile &own = AddFile("uav1");
    own.AddMetadata("rabit.file",
                    {{"node", "uav1"}, {"number", "7"}, {"recording", "uav1_000007_20261123T024640Z"}});
    own.Add(own.Posted("uav1", "MissionState"), 1, 1);
    own.Channel("uav1/Recorder/Log", {{"rabit.kind", "recorder"}}, "foxglove.Log", "json");
    // A recorder repeats the state at the beginning of a file.
    PlayedFile &ground = AddFile("ground");
    const std::uint16_t mirrored = ground.Mirrored("uav1", "MissionState");
    ground.Add(mirrored, 1, 1);
    ground.Add(mirrored, 2, 1);
    EXPECT_THAT(Plan().Lacks, IsEmpty());
}

// As those that came to another node later, before the files of the own one were removed.
TEST_F(ReplayPlanTest, MessagesThatAnOwnRecordingLacksAndAnotherHasAreTold)
{
    PlayedFile &own = AddFile("uav1");
    own.Add(own.Posted("uav1", "Pose"), 1, 1);
    PlayedFile &ground = AddFile("ground");
    const std::uint16_t live = ground.Mirrored("uav1", "Pose");
    const std::uint16_t later =
        ground.Channel("uav1/Pose", {{"rabit.kind", "backfilled"}, {"rabit.node", "uav1"}});
    for (std::uint64_t at = 1; at <= 3; ++at)
    {
        ground.Add(live, at, 1);
        ground.Add(later, at + 10, 1);
    }
    ground.Add(ground.Mirrored("uav1", "Findings"), 1, 1);
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), UnorderedElementsAre("uav1/Pose<uav1", "uav1/Findings<ground"));
    EXPECT_THAT(plan.Lacks, UnorderedElementsAre(
                                "uav1/Pose: played from the recording of uav1, which has 1 messages, though "
                                "that of ground has 6",
                                "uav1/Findings: not in the recording of uav1; played as ground has it"));
    EXPECT_THAT(Plan({.Exclude = {"*/*"}}).Lacks, IsEmpty()) << "neither is played";
}

TEST_F(ReplayPlanTest, LossesOfTwoRecordersAreToldApart)
{
    for (const auto &[node, lost] : {std::pair("ground", "3"), std::pair("uav1", "4")})
    {
        AddFile(node).AddMetadata("rabit.losses", {{"uav1/Pose", lost}});
    }
    EXPECT_THAT(Plan().Lacks, ElementsAre("ground did not record 3 messages of uav1/Pose",
                                          "uav1 did not record 4 messages of uav1/Pose"));
}

TEST_F(ReplayPlanTest, WhatAFileSaysThatItLacksIsToldOnce)
{
    for (const char *lost : {"4", "7"})
    {
        PlayedFile &file = AddFile("uav1");
        file.AddMetadata("rabit.losses", {{"uav1/Pose", lost}});
        file.AddMetadata("rabit.not_recorded", {{"queue messages", "`record: queues` is off"},
                                                {"Plain", "its type was not made from IDL"},
                                                {"Other", "its type was not made from IDL"}});
        file.Channel("uav1/Json", {}, "x", "json");
    }
    EXPECT_THAT(Plan().Lacks,
                ElementsAre("uav1 did not record 7 messages of uav1/Pose",
                            "uav1 did not record queue messages: `record: queues` is off",
                            "uav1 did not record Other, Plain: its type was not made from IDL",
                            "without CDR and the IDL of their types, and not played: `uav1/Json`"));
}

TEST_F(ReplayPlanTest, FilesThatAreMissingOfARecordingAreTold)
{
    for (const char *number : {"4", "5", "9"})
    {
        AddFile("uav1").AddMetadata(
            "rabit.file",
            {{"node", "uav1"}, {"number", number}, {"recording", "uav1_000003_20261123T024640Z"}});
    }
    EXPECT_THAT(Plan().Lacks,
                ElementsAre("uav1: file 3 is missing of recording uav1_000003_20261123T024640Z",
                            "uav1: files 6 to 8 are missing of recording uav1_000003_20261123T024640Z"));
}

TEST_F(ReplayPlanTest, OfWhatOthersRecordedThatOfWhoHasMostOfItIsPlayed)
{
    for (const auto &[recorder, messages] :
         {std::pair("uav2", 3), std::pair("ground", 5), std::pair("uav3", 4)})
    {
        PlayedFile &file = AddFile(recorder);
        const std::uint16_t channel = file.Mirrored("uav1", "Pose");
        for (int at = 1; at <= messages; ++at)
        {
            file.Add(channel, static_cast<std::uint64_t>(at), 1);
        }
    }
    EXPECT_THAT(NamesOf(Plan()), ElementsAre("uav1/Pose<ground"));
}

TEST_F(ReplayPlanTest, TheFilesOfOneRecorderAreOneStream)
{
    for (int part = 0; part < 2; ++part)
    {
        PlayedFile &file = AddFile("uav1");
        file.Channel("uav1/Log", {}, "x", "json");
        file.Posted("uav1", "Pose");
    }
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), ElementsAre("uav1/Pose<uav1"));
    ASSERT_EQ(plan.Channels.size(), 2U);
    EXPECT_EQ(plan.Channels[0].at(1), 0U);
    EXPECT_EQ(plan.Channels[1].at(1), 0U);
}

TEST_F(ReplayPlanTest, QueueMessagesArePlayedOnlyIfTheyAreNamedAndOnce)
{
    PlayedFile &ground = AddFile("ground");
    ground.Queue("ground", "sent", "uav1", "MissionControl");
    ground.Queue("ground", "refused", "uav2", "MissionControl");
    AddFile("uav1").Queue("uav1", "received", "ground", "MissionControl");
    EXPECT_THAT(NamesOf(Plan()), IsEmpty());
    const ReplayPlan plan = Plan({.Queues = {"*/MissionControl"}});
    EXPECT_THAT(NamesOf(plan), ElementsAre("ground>uav1/MissionControl"));
    EXPECT_TRUE(plan.Channels[1].empty()) << "as it was sent";
    files.pop_front();
    EXPECT_THAT(NamesOf(Plan({.Queues = {"uav1/*"}})), ElementsAre("ground>uav1/MissionControl"))
        << "as it was received";
}

TEST_F(ReplayPlanTest, AMergedRecordingIsPlayedAsItsPartsWouldBe)
{
    PlayedFile &file = AddFile("", {{"kind", "merge"}});
    file.AddMetadata("rabit.recording", {{"node", "uav1"}, {"domain", "3"}});
    file.AddMetadata("rabit.recording", {{"node", "ground"}, {"domain", "3"}});
    file.AddMetadata("rabit.recording", {{"node", "rabit.vm.7"}, {"kind", "rabit record"}});
    const auto knew = [&file](const std::string &recorder, const std::string &node)
    {
        file.Channel(recorder + "/Recorder/knew/" + node + "/Pose", {{"rabit.kind", "knew"},
                                                                     {"rabit.node", node},
                                                                     {"rabit.message", "Pose"},
                                                                     {"rabit.recorded_by", recorder}});
    };
    file.Posted("uav1", "Pose", "telemetry");
    knew("ground", "uav1");
    knew("ground", "uav2");
    const ReplayPlan plan = Plan();
    EXPECT_THAT(NamesOf(plan), UnorderedElementsAre("uav1/Pose<uav1", "uav2/Pose<ground"));
    EXPECT_THAT(plan.Nodes, ElementsAre("ground", "uav1", "uav2"));
    EXPECT_THAT(plan.Domains, ElementsAre("3"));
}

TEST_F(ReplayPlanTest, WhatCannotBeAMessageOfANodeIsPassedOver)
{
    PlayedFile &file = AddFile("u v");
    file.Channel("Pose", {});
    file.Channel("u v/Pose", {});
    file.Channel("uav1/", {});
    file.Channel("uav1//Pose", {});
    file.Channel("uav1/Pose", {{"rabit.kind", "queue sent"}});
    file.Channel("uav1/Recorder/Log", {{"rabit.kind", "recorder"}}, "foxglove.Log", "json");
    file.Channel("uav1/Json", {}, "x", "json");
    const ReplayPlan plan = Plan({.Queues = {"*"}});
    EXPECT_THAT(NamesOf(plan), IsEmpty());
    EXPECT_THAT(plan.Nodes, IsEmpty());
}

TEST_F(ReplayPlanTest, AFileOfAnotherProgramIsPlayedAsFarAsItsTopicsAreMessagesOfNodes)
{
    AddFile("").Channel("robot/Odometry", {});
    EXPECT_THAT(NamesOf(Plan()), ElementsAre("robot/Odometry<"));
}

}  // namespace
}  // namespace Rabit::Replay
