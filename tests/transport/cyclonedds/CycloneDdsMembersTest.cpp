// The Cyclone DDS backend between members of a fleet with keys.
#include <gmock/gmock.h>
#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <memory>
#include <string>
#include <utility>

#include "../conformance/NetworkFixture.h"
#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"
#include "../conformance/UdpTap.h"

namespace Rabit::Conformance
{

namespace
{

using Kind = PeerEvent::Kind;

// The content of samples in these tests, which no datagram may show.
const std::string Words = "words that nobody else may read";

class CycloneDdsMembersTest : public testing::Test, protected NetworkFixture
{
protected:
    CycloneDdsMembersTest()
        : NetworkFixture(std::make_unique<ProcessHarness>(std::make_unique<CycloneDdsTransport>(), "fleet"))
    {
    }

    TransportSettings SettingsWith(const std::string &node, std::shared_ptr<FleetMember> member)
    {
        TransportSettings settings = Settings(node);
        settings.Member = std::move(member);
        return settings;
    }
    // Expects that a member is refused with this element in its vendor's configuration.
    void ExpectRefusalWith(const std::string &element)
    {
        auto settings = Settings("uav1");
        settings.BackendConfig =
            TemporaryFile("<CycloneDDS><Domain Id=\"any\">" + element + "</Domain></CycloneDDS>");
        ExpectRefusal(settings, settings.BackendConfig, "backend_config");
    }
};

TEST_F(CycloneDdsMembersTest, ALargeSampleArrivesInSmallDatagrams)
{
    SampleRecorder recorder;
    const auto writing = Backend().Open(Settings("uav1"), {});
    const auto reading = Backend().Open(Settings("ground"), {});
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const std::string text(1'000'000, 'x');
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1), WriteResult::Ok);
    ASSERT_TRUE(Net().Until([&] { return recorder.Count() == 1; }));
    EXPECT_EQ(recorder.Texts()[0], text);
}

TEST_F(CycloneDdsMembersTest, ALargeSampleArrivesInLargeDatagrams)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.MaxDatagram = other.MaxDatagram = TransportSettings::LargestDatagram;
    SampleRecorder recorder;
    const auto writing = Backend().Open(one, {});
    const auto reading = Backend().Open(other, {});
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const std::string text(4'000'000, 'x');
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1), WriteResult::Ok);
    ASSERT_TRUE(Net().Until([&] { return recorder.Count() == 1; }));
    EXPECT_EQ(recorder.Texts()[0], text);
}

// The other program without keys shows that the first one is on the network.
TEST_F(CycloneDdsMembersTest, AProgramWithoutKeysHearsNothingAndIsNotHeard)
{
    PeerRecorder atGround;
    PeerRecorder atPlain;
    SampleRecorder heardByGround;
    SampleRecorder heardByPlain;
    const auto uav = Backend().Open(Settings("uav1"), {});
    const auto ground = Backend().Open(Settings("ground"), atGround.Handler());
    const auto plain = Backend().Open(SettingsWith("plain", nullptr), atPlain.Handler());
    const auto witness = Backend().Open(SettingsWith("witness", nullptr), {});
    const auto writer = uav->CreateWriter(TextTopic(), State(), {});
    const auto plainWriter = witness->CreateWriter(TextTopic(), State(), {});
    const auto reader = ground->CreateReader(TextTopic(), State(), {}, heardByGround.Handler());
    const auto plainReader = plain->CreateReader(TextTopic(), State(), {}, heardByPlain.Handler());
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "member"), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*plainWriter, MakeSample(0, "plain"), 1), WriteResult::Ok);
    ASSERT_TRUE(Net().Until([&] { return heardByGround.Count() > 0 && heardByPlain.Count() > 0; }));
    EXPECT_THAT(heardByGround.Texts(), testing::Each("member"));
    EXPECT_THAT(heardByPlain.Texts(), testing::Each("plain"));
    EXPECT_EQ(atGround.CountAll(), 1u);
    EXPECT_EQ(atGround.Count(Kind::Appeared, "uav1", 1), 1);
    EXPECT_EQ(atPlain.CountAll(), 1u);
    EXPECT_EQ(atPlain.Count(Kind::Appeared, "witness", 1), 1);
}

TEST_F(CycloneDdsMembersTest, NothingThatGoesToAGroupIsPlain)
{
    const int first = 7400 + 250 * Settings("uav1").Domain;
    UdpTap discovery(first, "239.255.0.1");
    UdpTap samples(first + 1, "239.255.0.1");
    SampleRecorder here;
    SampleRecorder there;
    const auto uav = Backend().Open(Settings("uav1"), {});
    const auto ground = Backend().Open(Settings("ground"), {});
    const auto other = Backend().Open(Settings("uav2"), {});
    const auto writer = uav->CreateWriter(TextTopic(), State(), {});
    const auto reader = ground->CreateReader(TextTopic(), State(), {}, here.Handler());
    const auto otherReader = other->CreateReader(TextTopic(), State(), {}, there.Handler());
    ASSERT_TRUE(Net().Until([&] { return writer->MatchedReaders() == 2; }));
    ASSERT_TRUE(Net().Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, Words), 1), WriteResult::Ok);
            return here.Count() >= 3 && there.Count() >= 3;
        }));
    EXPECT_GT(discovery.Sealed(), 0u);
    EXPECT_GT(samples.Sealed(), 0u);
    EXPECT_EQ(discovery.Plain() + samples.Plain(), 0u);
    EXPECT_FALSE(discovery.Saw(Words) || samples.Saw(Words));
}

TEST_F(CycloneDdsMembersTest, NothingThatGoesToAListedPeerIsPlain)
{
    UdpTap peer(0, "");
    auto settings = Settings("uav1");
    settings.Multicast = false;
    settings.Peers = {"127.0.0.1:" + std::to_string(peer.Port())};
    const auto uav = Backend().Open(settings, {});
    ASSERT_TRUE(Net().Until([&] { return peer.Sealed() >= 5; }));
    EXPECT_EQ(peer.Plain(), 0u);
    EXPECT_FALSE(peer.Saw("RTPS"));
}

TEST_F(CycloneDdsMembersTest, NoSealedDatagramIsLargerThanTheLargestOne)
{
    const int first = 7400 + 250 * Settings("uav1").Domain;
    UdpTap samples(first + 1, "239.255.0.1");
    SampleRecorder here;
    SampleRecorder there;
    auto settings = Settings("uav1");
    const auto uav = Backend().Open(settings, {});
    const auto ground = Backend().Open(Settings("ground"), {});
    const auto other = Backend().Open(Settings("uav2"), {});
    const auto writer = uav->CreateWriter(TextTopic(), State(), {});
    const auto reader = ground->CreateReader(TextTopic(), State(), {}, here.Handler());
    const auto otherReader = other->CreateReader(TextTopic(), State(), {}, there.Handler());
    ASSERT_TRUE(Net().Until([&] { return writer->MatchedReaders() == 2; }));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, std::string(50'000, 'x')), 1), WriteResult::Ok);
    ASSERT_TRUE(Net().Until([&] { return here.Count() == 1 && there.Count() == 1; }));
    EXPECT_GT(samples.Largest(), settings.MaxDatagram / 2);
    EXPECT_LE(samples.Largest(), settings.MaxDatagram);
}

TEST_F(CycloneDdsMembersTest, SharedMemoryIsRefused)
{
    auto settings = Settings("uav1");
    settings.SharedMemory = true;
    ExpectRefusal(settings, "shared_memory", "shared_memory");
}

TEST_F(CycloneDdsMembersTest, AConfigurationWithSharedMemoryIsRefused)
{
    ExpectRefusalWith("<SharedMemory><Enable>true</Enable></SharedMemory>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationWithDdsSecurityIsRefused)
{
    ExpectRefusalWith("<Security><Authentication></Authentication></Security>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationWithTcpIsRefused)
{
    ExpectRefusalWith("<General><Transport>tcp</Transport></General>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationWithASocketForEachParticipantIsRefused)
{
    ExpectRefusalWith("<Compatibility><ManySocketsMode>many</ManySocketsMode></Compatibility>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationWithSeveralReceivingThreadsIsRefused)
{
    ExpectRefusalWith("<Internal><MultipleReceiveThreads>true</MultipleReceiveThreads></Internal>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationThatShowsTheVendorsStateIsRefused)
{
    ExpectRefusalWith("<Internal><MonitorPort>0</MonitorPort></Internal>");
}

TEST_F(CycloneDdsMembersTest, AnotherConfigurationIsAccepted)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile(
        "<CycloneDDS><Domain Id=\"any\"><Internal><NackDelay>2ms</NackDelay></Internal>"
        "</Domain></CycloneDDS>");
    ExpectDelivery(settings, Settings("ground"));
}

}  // namespace

}  // namespace Rabit::Conformance
