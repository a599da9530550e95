#include "recording/RecordingInbox.h"

#include <gtest/gtest.h>
#include <rabit/mcap/McapWriter.h>

#include <thread>

namespace Rabit
{
namespace
{

RecordingItem ItemOf(std::uint32_t stream, std::size_t bytes)
{
    return {stream, 0, 1, 1, Mcap::Bytes(bytes)};
}

TEST(RecordingInbox, GivesOutWhatWasPutInOnceAndInOrder)
{
    RecordingInbox inbox(1U << 20);
    const std::uint32_t pose = inbox.AddStream({.Topic = "uav1/Pose", .SchemaName = ""});
    const std::uint32_t health = inbox.AddStream({.Topic = "uav1/Health", .SchemaName = ""});
    inbox.SetMetadata("rabit.configuration", {{"node", "uav1"}});
    EXPECT_TRUE(inbox.Put(ItemOf(health, 1)));
    EXPECT_TRUE(inbox.Put(ItemOf(pose, 2)));
    RecordingInbox::Batch batch;
    inbox.Take(batch, std::chrono::milliseconds(0));
    ASSERT_EQ(batch.NewStreams.size(), 2U);
    EXPECT_EQ(batch.NewStreams[1]->Topic, "uav1/Health");
    ASSERT_EQ(batch.Items.size(), 2U);
    EXPECT_EQ(batch.Items[0].Stream, health);
    EXPECT_EQ(batch.Items[1].Stream, pose);
    EXPECT_EQ(batch.Metadata.size(), 1U);
    EXPECT_TRUE(batch.Lost.empty());
    inbox.Take(batch, std::chrono::milliseconds(0));
    EXPECT_TRUE(batch.NewStreams.empty() && batch.Items.empty() && batch.Metadata.empty());
}

TEST(RecordingInbox, RefusesAndCountsWhatHasNoRoomUntilWhatWasTakenIsDone)
{
    RecordingInbox inbox(10 * (RecordingInbox::ItemSize + 100));
    const std::uint32_t stream = inbox.AddStream({.Topic = "a", .SchemaName = ""});
    for (int count = 0; count < 10; ++count)
    {
        EXPECT_TRUE(inbox.Put(ItemOf(stream, 100)));
    }
    EXPECT_FALSE(inbox.Put(ItemOf(stream, 100)));
    RecordingInbox::Batch batch;
    inbox.Take(batch, std::chrono::milliseconds(0));
    EXPECT_EQ(batch.Lost, std::vector<std::uint64_t>{1});
    EXPECT_FALSE(inbox.Put(ItemOf(stream, 100))) << "it is being written";
    inbox.Done(batch);
    EXPECT_TRUE(inbox.Put(ItemOf(stream, 100)));
}

TEST(RecordingInbox, LeavesRoomForOthersThanPictures)
{
    RecordingInbox inbox(40 * Mcap::McapWriter::LargeMessage);
    const std::uint32_t picture = inbox.AddStream({.Topic = "Picture", .SchemaName = ""});
    const std::uint32_t pose = inbox.AddStream({.Topic = "Pose", .SchemaName = ""});
    while (inbox.Put(ItemOf(picture, Mcap::McapWriter::LargeMessage)))
    {
    }
    for (int count = 0; count < 500; ++count)
    {
        EXPECT_TRUE(inbox.Put(ItemOf(pose, 100)));
    }
}

TEST(RecordingInbox, TakesNothingMoreOnceItIsClosed)
{
    RecordingInbox inbox(1U << 20);
    const std::uint32_t stream = inbox.AddStream({.Topic = "a", .SchemaName = ""});
    inbox.Put(ItemOf(stream, 1));
    inbox.Close();
    EXPECT_FALSE(inbox.Put(ItemOf(stream, 1)));
    RecordingInbox::Batch batch;
    inbox.Take(batch, std::chrono::hours(1));
    EXPECT_TRUE(batch.IsEnd);
    EXPECT_EQ(batch.Items.size(), 1U);
}

TEST(RecordingInbox, WakesWhoWaitsWhenHalfOfTheRoomIsTaken)
{
    RecordingInbox inbox(1U << 20);
    const std::uint32_t stream = inbox.AddStream({.Topic = "a", .SchemaName = ""});
    std::thread putter(
        [&]
        {
            for (int count = 0; count < 60; ++count)
            {
                inbox.Put(ItemOf(stream, 10000));
            }
        });
    RecordingInbox::Batch batch;
    inbox.Take(batch, std::chrono::hours(1));
    EXPECT_GE(batch.Items.size(), 50U);
    putter.join();
}

}  // namespace
}  // namespace Rabit
