// Live posts in a pause: which come later, and which never would.
#include "backfill/SeriesStreams.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>

#include <chrono>
#include <memory>
#include <vector>

#include "FakeDisk.h"

namespace Rabit::Backfill
{
namespace
{

constexpr std::int64_t Millisecond = 1'000'000;
const Series Pose{"uav1", "Pose", 7};

class SeriesStreamsTest : public testing::Test
{
protected:
    static GatewayConfig Config()
    {
        GatewayConfig config;
        config.Node = "ground";
        config.Record.emplace();
        config.Record->Backfill = {"Pose"};
        return config;
    }
    static std::shared_ptr<RecordingTarget> Target(const RabitClock &time)
    {
        RecordingSettings settings;
        settings.Name = "ground";
        settings.Record.Folder = "/recordings";
        return std::make_shared<RecordingTarget>("ground", time, std::make_unique<FakeDisk>(), settings);
    }

    void PostLive(std::int64_t milliseconds)
    {
        const std::vector<std::uint8_t> bytes(10);
        GatewayTap::MirroredSample sample;
        sample.Node = Pose.Node;
        sample.Message = Pose.Message;
        sample.Incarnation = Pose.Incarnation;
        sample.SourceTime = milliseconds * Millisecond;
        sample.PostedAt = std::chrono::milliseconds(milliseconds);
        sample.Sample = bytes;
        streams.TakeLive(sample);
    }
    bool IsRecorded(std::int64_t milliseconds)
    {
        const Stamp stamp = StampOf(milliseconds * Millisecond);
        const bool isNew = ledger->Take(Pose, stamp);
        if (isNew)
        {
            ledger->Undo(Pose, stamp);
        }
        return !isNew;
    }

    ManualClock clock{1'400'000'000.0};
    std::shared_ptr<Ledger> ledger = std::make_shared<Ledger>();
    SeriesStreams streams{Config(), Target(clock), ledger};
};

TEST_F(SeriesStreamsTest, OfTheFirstPauseTheNewestPostIsRecorded)
{
    PostLive(10);
    PostLive(20);
    EXPECT_FALSE(IsRecorded(20)) << "it is known later what the recordings have";
    streams.SetPaused(false);
    EXPECT_FALSE(IsRecorded(10)) << "it comes later";
    EXPECT_TRUE(IsRecorded(20)) << "its origin may not record";
    PostLive(30);
    EXPECT_TRUE(IsRecorded(30));
}

// The recordings may be read again before it is in them.
TEST_F(SeriesStreamsTest, OfLaterPausesNoPostIsRecordedThatComesLater)
{
    streams.SetPaused(false);
    streams.SetPaused(true);
    PostLive(10);
    streams.SetPaused(false);
    EXPECT_FALSE(IsRecorded(10));
}

TEST_F(SeriesStreamsTest, PostsThatDoNotComeLaterAreRecordedDuringAPause)
{
    streams.SetPaused(false);
    streams.SetLiveOnly({{"uav1", "Pose"}});
    streams.SetPaused(true);
    PostLive(10);
    PostLive(20);
    EXPECT_TRUE(IsRecorded(10));
    EXPECT_TRUE(IsRecorded(20));
    streams.SetLiveOnly({{"uav2", "Pose"}, {"uav1", "Findings"}});
    PostLive(30);
    EXPECT_FALSE(IsRecorded(30));
}

}  // namespace
}  // namespace Rabit::Backfill
