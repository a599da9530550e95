// The samples of a writer that goes.
#include "KeepLastHistory.h"

#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "../../Eventually.h"

namespace
{

using Rabit::FastDds::KeepLastHistory;
namespace rtps = Rabit::FastDds::rtps;

class NoEvents final : public Rabit::FastDds::WriterEvents
{
    void OnMatched(rtps::RTPSWriter &, const rtps::MatchingInfo &) override {}
    void OnReceivedByAll(const rtps::CacheChange_t &) override {}
};

// Looks at the history of a writer each time that a buffer comes back.
class WatchingPool final : public Rabit::FastDds::Buffers
{
public:
    KeepLastHistory *History = nullptr;
    std::vector<std::size_t> Sizes;

private:
    using Payload = rtps::SerializedPayload_t;

    bool Take(std::uint32_t size, Payload &payload) override
    {
        payload.data = _bytes.data();
        payload.max_size = size;
        payload.length = size;
        return true;
    }
    bool TakeCopy(const Payload &data, Payload &payload) override { return Take(data.length, payload); }
    void GiveBack(Payload &payload) override
    {
        payload.data = nullptr;
        Sizes.push_back(History->getHistorySize());
    }

    std::vector<rtps::octet> _bytes = std::vector<rtps::octet>(16);  // of all payloads
};

// A participant that is not enabled sends nothing.
class KeepLastHistoryTest : public testing::Test
{
protected:
    ~KeepLastHistoryTest() override { rtps::RTPSDomain::removeRTPSParticipant(Participant); }

    rtps::RTPSParticipant *const Participant =
        rtps::RTPSDomain::createParticipant(0, false, rtps::RTPSParticipantAttributes());
    NoEvents Events;
};

// The vendor's timer looks at the history whenever nobody holds the writer's lock.
TEST_F(KeepLastHistoryTest, HasNoSampleThatIsFreedWhileItsWriterGoes)
{
    const auto pool = std::make_shared<WatchingPool>();
    KeepLastHistory history(3, true, pool);
    pool->History = &history;
    rtps::WriterAttributes attributes;
    attributes.endpoint.reliabilityKind = rtps::RELIABLE;
    attributes.endpoint.durabilityKind = rtps::TRANSIENT_LOCAL;
    rtps::RTPSWriter *const writer =
        Rabit::FastDds::MakeWriter(*Participant, attributes, pool, history, Events);
    ASSERT_NE(writer, nullptr);
    for (int i = 0; i < 3; ++i)
    {
        rtps::CacheChange_t *const change = Rabit::FastDds::SentHistory::New(*writer, history, rtps::ALIVE);
        ASSERT_NE(change, nullptr);
        ASSERT_TRUE(pool->get_payload(8, *change));
        rtps::WriteParams params;
        const std::lock_guard lock(writer->getMutex());
        ASSERT_TRUE(history.Add(*change, params, RabitTest::WhenItHangs()));
    }
    history.RemoveWriter(writer);
    EXPECT_THAT(pool->Sizes, testing::ElementsAre(2u, 1u, 0u));
}

// Version 3 has no such fault, and shows no such history.
#if RABIT_FASTDDS_MAJOR < 3
TEST_F(KeepLastHistoryTest, TheVendorsOwnWritersHaveNoSampleWhenTheyGo)
{
    const auto pool = std::make_shared<WatchingPool>();
    const auto announce = [&](KeepLastHistory &history, const char *topic)
    {
        rtps::WriterAttributes attributes;
        attributes.endpoint.reliabilityKind = rtps::RELIABLE;
        rtps::RTPSWriter *const writer =
            Rabit::FastDds::MakeWriter(*Participant, attributes, pool, history, Events);
        EXPECT_TRUE(Rabit::FastDds::Announce(*Participant, writer,
                                             {.Topic = topic, .Type = "Uav::Pose", .HasKey = false}, {}));
        return writer;
    };
    rtps::RTPSWriter *const announcing =
        Rabit::FastDds::FindWriter({Participant->getGuid().guidPrefix, Rabit::Rtps::PublicationsWriter});
    ASSERT_NE(announcing, nullptr);
    KeepLastHistory first(3, true, pool);
    KeepLastHistory second(3, true, pool);
    rtps::RTPSWriter *const pose = announce(first, "Pose");
    EXPECT_TRUE(announcing->remove_older_changes());  // an announcement is a sample
    rtps::RTPSWriter *const state = announce(second, "State");
    Rabit::FastDds::RemoveOwnSamples(*Participant);
    EXPECT_FALSE(announcing->remove_older_changes());
    first.RemoveWriter(pose);
    second.RemoveWriter(state);
}
#endif

}  // namespace
