// Reports in beats of the delay of this node's datagrams, and beats without one.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "BeatSamples.h"
#include "MessageSample.h"
#include "names/NodeTag.h"
#include "presence/Presence.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

// Keeps the handler of the beats.
class BeatSession final : public TransportSession
{
public:
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &) override
    {
        return nullptr;
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &,
                                                  SampleHandler handler) override
    {
        OnBeat = std::move(handler);
        return nullptr;
    }
    TransportCounters Counters() const override { return {}; }

    SampleHandler OnBeat;
};

class PresenceDelaysTest : public ::testing::Test
{
protected:
    PresenceDelaysTest() { presence.Open(session, {}); }

    // Another node's beat, with reports of the datagrams of these nodes.
    const Presence::Served &Hear(const std::vector<std::uint32_t> &tags)
    {
        clock.Advance(500ms);
        Gateway::Beat beat = BeatAt(clock.Monotonic() + 1000s);
        for (const std::uint32_t tag : tags)
        {
            Gateway::DelayReport &report = NewsOf(beat).delays.emplace_back();
            report.node = tag;
            report.delay_ms = 300;
        }
        const MessageSample sample(beat);
        std::vector<std::uint8_t> bytes(sample.EncodedSize());
        EXPECT_TRUE(sample.Encode(bytes));
        SampleInfo info;
        info.Node = "uav2";
        info.Incarnation = 5;
        session.OnBeat(bytes, info);
        return presence.Service(clock.Monotonic());
    }

    ManualClock clock{1.4e9, 1000s};
    SourceClock source{clock};
    OriginTable origins;
    RemoteQueues remote{"uav1"};
    BeatSession session;
    const std::uint32_t own = NodeTagOf("uav1", 7);
    Presence presence{"uav1",
                      7,
                      clock,
                      source,
                      origins,
                      remote,
                      [] { return 1; },
                      [](const std::string &) { return false; },
                      [] {},
                      [](const std::string &) { return true; }};
};

TEST_F(PresenceDelaysTest, AListWithoutThisNodeTellsThatNothingOfItIsLate)
{
    EXPECT_EQ(Hear({}).NothingLate.size(), 1u);
    EXPECT_EQ(Hear({own + 1, own + 2, own + 3}).NothingLate.size(), 1u);
}

// The nodes take turns.
TEST_F(PresenceDelaysTest, AFullListTellsNothingOfTheNodesThatDidNotFit)
{
    const Presence::Served &served = Hear({own + 1, own + 2, own + 3, own + 4});
    EXPECT_TRUE(served.NothingLate.empty());
    EXPECT_TRUE(served.Delays.empty());
}

TEST_F(PresenceDelaysTest, AFullListTellsOfTheNodesInIt)
{
    const Presence::Served &served = Hear({own + 1, own + 2, own + 3, own});
    EXPECT_TRUE(served.NothingLate.empty());
    ASSERT_EQ(served.Delays.size(), 1u);
    EXPECT_EQ(served.Delays[0].Delay, 300ms);
}

}  // namespace
}  // namespace Rabit
