#include "recording/replay/RecordedMessages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <vector>

#include "PlayedFile.h"

namespace Rabit::Replay
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr Time Second = 1'000'000'000;

class RecordedMessagesTest : public ::testing::Test
{
protected:
    RecordedMessages &Open(const PlanSettings &settings = {})
    {
        std::vector<const Mcap::Contents *> contents;
        std::vector<RecordedMessages::File> opened;
        for (PlayedFile &file : files)
        {
            contents.push_back(&file.Contents());
            opened.push_back({&file.File(), &file.Contents()});
        }
        plan = PlanReplay(contents, settings);
        return recorded.emplace_back(opened, plan);
    }
    static std::vector<int> All(RecordedMessages &messages, Time from = 0)
    {
        std::vector<int> values;
        messages.Begin(from);
        while (const auto item = messages.Next())
        {
            values.push_back(item->Data.at(0));
        }
        return values;
    }
    static std::vector<int> Before(RecordedMessages &messages, Time time)
    {
        std::vector<int> values;
        for (const ReplayItem &item : messages.LastBefore(time))
        {
            values.push_back(item.Data.at(0));
        }
        return values;
    }

    std::deque<PlayedFile> files;
    ReplayPlan plan;
    std::deque<RecordedMessages> recorded;
};

TEST_F(RecordedMessagesTest, SeveralFilesAreOneTimeLine)
{
    PlayedFile &uav1 = files.emplace_back("uav1");
    PlayedFile &uav2 = files.emplace_back("uav2");
    const std::uint16_t first = uav1.Posted("uav1", "Pose");
    const std::uint16_t second = uav2.Posted("uav2", "Pose");
    uav1.Add(first, 1 * Second, 1);
    uav2.Add(second, 2 * Second, 2);
    uav1.Add(first, 3 * Second, 3);
    uav2.Add(second, 3 * Second, 4);
    RecordedMessages &messages = Open();
    EXPECT_THAT(All(messages), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(All(messages, 2 * Second + 1), ElementsAre(3, 4));
    EXPECT_EQ(messages.First(), 1 * Second);
    EXPECT_EQ(messages.Last(), 3 * Second);
}

TEST_F(RecordedMessagesTest, AStateThatIsRepeatedAtTheBeginningOfAFileComesOnce)
{
    PlayedFile &first = files.emplace_back("uav1");
    PlayedFile &second = files.emplace_back("uav1");
    first.Add(first.Posted("uav1", "MissionState"), 1 * Second, 1);
    const std::uint16_t channel = second.Posted("uav1", "MissionState");
    second.Add(channel, 5 * Second, 1, 1 * Second);
    second.Add(channel, 6 * Second, 1);
    RecordedMessages &messages = Open();
    EXPECT_THAT(All(messages), ElementsAre(1, 1)) << "it was posted twice";
    EXPECT_THAT(All(messages, 5 * Second), ElementsAre(1, 1)) << "alone a file has it at its beginning";
}

TEST_F(RecordedMessagesTest, WhatIsNotSelectedDoesNotCome)
{
    PlayedFile &file = files.emplace_back("uav1");
    file.Add(file.Posted("uav1", "Pose"), 1 * Second, 1);
    file.Add(file.Posted("uav1", "Health"), 2 * Second, 2);
    RecordedMessages &messages = Open({.Exclude = {"*/Pose"}});
    EXPECT_THAT(All(messages), ElementsAre(2));
    EXPECT_THAT(Before(messages, 10 * Second), ElementsAre(2));
}

TEST_F(RecordedMessagesTest, TheLastOfEachStreamBeforeAMomentIsFoundHoweverLongBefore)
{
    PlayedFile &file = files.emplace_back("uav1");
    const std::uint16_t area = file.Posted("uav1", "SearchArea");
    const std::uint16_t pose = file.Posted("uav1", "Pose");
    const std::uint16_t queue = file.Queue("uav1", "sent", "uav2", "MissionControl");
    file.Add(area, 1 * Second, 100);
    file.Add(queue, 2 * Second, 101);
    file.FinishChunk();
    for (std::uint8_t at = 1; at <= 90; ++at)
    {
        file.Add(pose, 10 * at * Second, at);
        file.FinishChunk();
    }
    RecordedMessages &messages = Open({.Queues = {"*"}});
    EXPECT_THAT(Before(messages, 855 * Second), ElementsAre(100, 85));
    EXPECT_THAT(Before(messages, 850 * Second), ElementsAre(100, 84)) << "what comes just then is not before";
    EXPECT_THAT(Before(messages, 10000 * Second), ElementsAre(100, 90));
    EXPECT_THAT(Before(messages, 1 * Second), IsEmpty());
    EXPECT_THAT(Before(messages, 0), IsEmpty());
}

TEST_F(RecordedMessagesTest, AFileThatWasCutOffIsPlayedAsFarAsItGoes)
{
    PlayedFile &file = files.emplace_back("uav1");
    const std::uint16_t pose = file.Posted("uav1", "Pose");
    for (std::uint8_t at = 1; at <= 9; ++at)
    {
        file.Add(pose, at * Second, at);
        file.FinishChunk();
    }
    file.Contents();
    const MemoryFile whole = file.File();
    std::size_t most = 0;
    for (std::size_t size = 0; size < whole.Content.size(); ++size)
    {
        MemoryFile cut(
            Mcap::Bytes(whole.Content.begin(), whole.Content.begin() + static_cast<std::ptrdiff_t>(size)));
        const Mcap::Contents contents = Mcap::ReadContents(cut);
        const ReplayPlan cutPlan = PlanReplay({&contents}, {});
        RecordedMessages messages({{&cut, &contents}}, cutPlan);
        const std::vector<int> values = All(messages);
        ASSERT_GE(values.size(), most) << size;
        most = values.size();
        ASSERT_EQ(Before(messages, 100 * Second).size(), values.empty() ? 0U : 1U) << size;
    }
    EXPECT_EQ(most, 9U);
}

TEST_F(RecordedMessagesTest, AChunkThatIsDamagedIsToldAndPassedOver)
{
    PlayedFile &file = files.emplace_back("uav1");
    const std::uint16_t pose = file.Posted("uav1", "Pose");
    for (std::uint8_t at = 1; at <= 3; ++at)
    {
        file.Add(pose, at * Second, at);
        file.FinishChunk();
    }
    const Mcap::ChunkIndex chunk = file.Contents().Chunks.at(1);
    file.File().Content.at(chunk.Offset + chunk.Length - 1) ^= 0xff;
    RecordedMessages &messages = Open();
    EXPECT_THAT(All(messages), ElementsAre(1, 3));
    EXPECT_THAT(messages.Problems(), SizeIs(1));
}

TEST_F(RecordedMessagesTest, AFileThatIsNoneHasNothing)
{
    MemoryFile none(Mcap::Bytes(100, 7));
    const Mcap::Contents contents = Mcap::ReadContents(none);
    const ReplayPlan empty = PlanReplay({&contents}, {});
    RecordedMessages messages({{&none, &contents}}, empty);
    EXPECT_THAT(All(messages), IsEmpty());
    EXPECT_EQ(messages.First(), 0U);
    EXPECT_EQ(messages.Last(), 0U);
}

}  // namespace
}  // namespace Rabit::Replay
