// Members of a fleet with keys on a simulated network.
#include <gmock/gmock.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"
#include "SimulatedHarness.h"

namespace Rabit::Conformance
{

namespace
{

class SimulatedMembersTest : public testing::Test
{
protected:
    std::unique_ptr<TransportSession> Open(const std::string &node)
    {
        return _net.Backend().Open(_net.SettingsFor(node, 1), {});
    }
    std::unique_ptr<TransportSession> OpenWith(const std::string &node, std::shared_ptr<FleetMember> member)
    {
        TransportSettings settings = _net.SettingsFor(node, 1);
        settings.Member = std::move(member);
        return _net.Backend().Open(settings, {});
    }
    bool Matched(const TransportWriter &writer, const TransportReader &reader)
    {
        return _net.Until([&] { return writer.MatchedReaders() == 1 && reader.MatchedWriters() == 1; });
    }

    SimulatedHarness _net{1, "fleet"};
};

TEST_F(SimulatedMembersTest, AProgramWithoutKeysHearsNothingAndIsNotHeard)
{
    const auto uav = Open("uav1");
    const auto ground = Open("ground");
    const auto plain = OpenWith("plain", nullptr);
    SampleRecorder atGround;
    SampleRecorder atPlain;
    const auto writer = uav->CreateWriter(TextTopic(), Telemetry(), {});
    const auto plainWriter = plain->CreateWriter(TextTopic(), Telemetry(), {});
    const auto reader = ground->CreateReader(TextTopic(), Telemetry(), {}, atGround.Handler());
    const auto plainReader = plain->CreateReader(TextTopic(), Telemetry(), {}, atPlain.Handler());
    ASSERT_TRUE(Matched(*writer, *reader));
    for (int i = 0; i < 100; ++i)
    {
        ASSERT_EQ(writer->Write(MakeSample(0, "member"), i), WriteResult::Ok);
        ASSERT_EQ(plainWriter->Write(MakeSample(0, "plain"), i), WriteResult::Ok);
        _net.Pass(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(atGround.Count(), 100u);
    EXPECT_THAT(atGround.Texts(), testing::Each("member"));
    EXPECT_EQ(atPlain.Count(), 0u);
    EXPECT_EQ(plainWriter->MatchedReaders(), 0);
}

TEST_F(SimulatedMembersTest, AMemberOfAnotherFleetHearsNothingAndIsNotHeard)
{
    const auto uav = Open("uav1");
    const auto other = OpenWith("other", TestMembers("other fleet").Member("other"));
    SampleRecorder atOther;
    const auto writer = uav->CreateWriter(TextTopic(), State(), {});
    const auto reader = other->CreateReader(TextTopic(), State(), {}, atOther.Handler());
    ASSERT_EQ(writer->Write(MakeSample(0, "secret"), 1), WriteResult::Ok);
    _net.Pass(std::chrono::seconds(30));
    EXPECT_EQ(atOther.Count(), 0u);
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
}

TEST_F(SimulatedMembersTest, OnATopicThatAMemberMayNotWriteNothingOfItIsDelivered)
{
    const TestMembers::Rules rules{{.Topic = "Allowed", .MayWrite = true, .MayRead = true},
                                   {.Topic = "Text", .MayWrite = false, .MayRead = true}};
    const auto uav = OpenWith("uav1", TestMembers("fleet").Member("uav1", rules));
    const auto ground = Open("ground");
    SampleRecorder allowed;
    SampleRecorder forbidden;
    const auto writer = uav->CreateWriter(TextTopic("Allowed"), State(), {});
    const auto other = uav->CreateWriter(TextTopic(), State(), {});
    const auto reader = ground->CreateReader(TextTopic("Allowed"), State(), {}, allowed.Handler());
    const auto otherReader = ground->CreateReader(TextTopic(), State(), {}, forbidden.Handler());
    ASSERT_TRUE(Matched(*writer, *reader));
    ASSERT_EQ(other->Write(MakeSample(0, "forbidden"), 1), WriteResult::Ok);
    ASSERT_EQ(writer->Write(MakeSample(0, "allowed"), 1), WriteResult::Ok);
    ASSERT_TRUE(_net.Until([&] { return allowed.Count() == 1; }));
    _net.Pass(std::chrono::seconds(30));
    EXPECT_EQ(forbidden.Count(), 0u);
    EXPECT_EQ(otherReader->MatchedWriters(), 0);
}

TEST_F(SimulatedMembersTest, ASampleToSeveralTakesTheBytesOfASignedSeal)
{
    const auto bytesOfSamples = [this](const std::string &suffix, bool keys)
    {
        const auto open = [&](const std::string &node)
        { return keys ? Open(node + suffix) : OpenWith(node + suffix, nullptr); };
        const auto uav = open("uav");
        const auto ground = open("ground");
        SampleRecorder recorder;
        const auto writer = uav->CreateWriter(TextTopic(), Telemetry(), {});
        const auto reader = ground->CreateReader(TextTopic(), Telemetry(), {}, recorder.Handler());
        EXPECT_TRUE(Matched(*writer, *reader));
        const std::uint64_t before = uav->Counters().SampleBytes;
        EXPECT_EQ(writer->Write(MakeSample(0, "sample"), 1), WriteResult::Ok);
        EXPECT_TRUE(_net.Until([&] { return recorder.Count() == 1; }));
        return uav->Counters().SampleBytes - before;
    };
    const std::uint64_t plain = bytesOfSamples("1", false);
    const std::uint64_t sealed = bytesOfSamples("2", true);
    // 11 bytes of header, 64 of signature and 16 of tag, without the 20 of the RTPS header; perhaps padding.
    EXPECT_GE(sealed, plain + 71);
    EXPECT_LE(sealed, plain + _net.MostAdded());
}

TEST(SimulatedMembers, ARunIsRepeatable)
{
    const auto run = []
    {
        SimulatedHarness net(7, "fleet");
        SimulatedFaults faults;
        faults.Loss = 0.2;
        net.Network().SetFaults("*", "*", faults);
        const auto uav = net.Backend().Open(net.SettingsFor("uav1", 1), {});
        const auto ground = net.Backend().Open(net.SettingsFor("ground", 1), {});
        SampleRecorder recorder;
        const auto writer = uav->CreateWriter(TextTopic(), State(), {});
        const auto reader = ground->CreateReader(TextTopic(), State(), {}, recorder.Handler());
        EXPECT_TRUE(net.Until([&] { return reader->MatchedWriters() == 1; }));
        net.Pass(std::chrono::seconds(20));
        return net.Network().Traffic();
    };
    const SimulatedTraffic first = run();
    const SimulatedTraffic second = run();
    EXPECT_EQ(first.Sent, second.Sent);
    EXPECT_EQ(first.Lost, second.Lost);
    EXPECT_EQ(first.Events, second.Events);
}

}  // namespace

}  // namespace Rabit::Conformance
