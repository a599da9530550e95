// Members of one fleet with keys, over different backends.
#include <gmock/gmock.h>
#include <rabit/cyclonedds/CycloneDdsTransport.h>
#include <rabit/fastdds/FastDdsTransport.h>

#include <memory>
#include <ostream>
#include <string>

#include "../common/TestMembers.h"
#include "../conformance/ForbiddenTopic.h"
#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"

namespace Rabit::Conformance
{

namespace
{

enum class Writing
{
    FastDds,
    CycloneDds
};

void PrintTo(Writing by, std::ostream *out)
{
    *out << (by == Writing::FastDds ? "fastdds" : "cyclonedds");
}

class MixedMembers : public testing::TestWithParam<Writing>
{
protected:
    // The backend that writes, and the other one.
    Transport &Writer() { return GetParam() == Writing::FastDds ? _fastdds : _net.Backend(); }
    Transport &Reader() { return GetParam() == Writing::FastDds ? _net.Backend() : _fastdds; }
    TransportSettings Settings(const std::string &node) { return _net.SettingsFor(node, 1); }

    void ExpectArrival(const std::string &text)
    {
        SampleRecorder recorder;
        const auto writing = Writer().Open(Settings("uav1"), {});
        const auto reading = Reader().Open(Settings("ground"), {});
        const auto writer = writing->CreateWriter(TextTopic(), State(), {});
        const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1), WriteResult::Ok);
        ASSERT_TRUE(_net.Until([&] { return recorder.Count() == 1; }));
        EXPECT_EQ(recorder.Texts()[0], text);
        EXPECT_EQ(recorder.All()[0].Node, "uav1");
    }

    ProcessHarness _net{std::make_unique<CycloneDdsTransport>(), "fleet"};
    FastDdsTransport _fastdds;
};

TEST_P(MixedMembers, ASampleArrives)
{
    ExpectArrival("sample");
}

TEST_P(MixedMembers, ALargeSampleArrives)
{
    ExpectArrival(std::string(1'000'000, 'x'));
}

// The forbidden writer is announced first.
TEST_P(MixedMembers, ATopicThatThePermissionsLackKeepsNoOtherOneBack)
{
    auto restricted = Settings("uav1");
    TestMembers fleet("fleet");
    restricted.Member = fleet.Member("uav1", {{.Topic = "Pose", .MayWrite = true, .MayRead = true}});
    const auto writing = Writer().Open(restricted, {});
    const auto reading = Reader().Open(Settings("ground"), {});
    const BesideForbidden told = TalkBesideForbidden(_net, *writing, *reading);
    ASSERT_TRUE(told.IsPoseHeard);
    EXPECT_EQ(told.Writers, 0);
    EXPECT_EQ(told.Heard, 0u);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Backends, MixedMembers, testing::Values(Writing::FastDds, Writing::CycloneDds));

}  // namespace Rabit::Conformance
