#include <gtest/gtest.h>
#include <rabit/mcap/RecordedChannel.h>

#include <string>
#include <utility>

namespace Rabit::Mcap
{
namespace
{

RecordedChannel Of(const std::string &topic, const TextMap &metadata)
{
    Channel channel;
    channel.Topic = topic;
    channel.Metadata = metadata;
    return Describe(channel);
}

void ExpectMessage(const RecordedChannel &described, ChannelKind kind, const std::string &node,
                   const std::string &recorder)
{
    EXPECT_EQ(described.Kind, kind);
    EXPECT_EQ(described.Node, node);
    EXPECT_EQ(described.Message, "Pose");
    EXPECT_EQ(described.Recorder, recorder);
}

TEST(RecordedChannel, OfAPostNamesNodeAndMessage)
{
    ExpectMessage(Of("uav1/Pose", {{"rabit.kind", "posted"}, {"rabit.node", "uav1"}}), ChannelKind::Posted,
                  "uav1", "uav1");
}

TEST(RecordedChannel, OfAnotherNodesPostNamesThatNode)
{
    ExpectMessage(Of("uav1/Pose", {{"rabit.kind", "mirrored"}, {"rabit.node", "uav1"}}),
                  ChannelKind::Mirrored, "uav1", "");
    ExpectMessage(Of("uav1/Pose", {{"rabit.kind", "backfilled"}, {"rabit.node", "uav1"}}),
                  ChannelKind::Backfilled, "uav1", "");
}

TEST(RecordedChannel, OfAMergedRecordingNamesTheRecorderToo)
{
    const TextMap common = {
        {"rabit.node", "uav1"}, {"rabit.message", "Pose"}, {"rabit.recorded_by", "ground"}};
    TextMap knew = common;
    knew["rabit.kind"] = "knew";
    ExpectMessage(Of("ground/Recorder/knew/uav1/Pose", knew), ChannelKind::Mirrored, "uav1", "ground");
    TextMap backfilled = common;
    backfilled["rabit.kind"] = "backfilled";
    ExpectMessage(Of("ground/Recorder/backfilled/uav1/Pose", backfilled), ChannelKind::Backfilled, "uav1",
                  "ground");
    backfilled.erase("rabit.message");  // as earlier versions merged
    ExpectMessage(Of("ground/Recorder/backfilled/uav1/Pose", backfilled), ChannelKind::Backfilled, "uav1",
                  "ground");
}

TEST(RecordedChannel, OfAQueueOrOfTheRecorderIsNoMessage)
{
    for (const auto &[word, kind] :
         {std::pair("queue sent", ChannelKind::QueueSent),
          std::pair("queue received", ChannelKind::QueueReceived),
          std::pair("queue refused", ChannelKind::QueueRefused), std::pair("recorder", ChannelKind::Recorder),
          std::pair("backfill", ChannelKind::Recorder)})
    {
        const RecordedChannel described =
            Of("uav1/Recorder/x", {{"rabit.kind", word}, {"rabit.node", "uav1"}});
        EXPECT_EQ(described.Kind, kind) << word;
        EXPECT_EQ(described.Node, "uav1");
        EXPECT_EQ(described.Message, "");
    }
}

TEST(RecordedChannel, OfAnotherProgramIsNamedByItsTopic)
{
    ExpectMessage(Of("uav1/Pose", {}), ChannelKind::Other, "uav1", "");
    EXPECT_EQ(Of("pose", {}).Message, "");
}

}  // namespace
}  // namespace Rabit::Mcap
