// The Cyclone DDS backend between members of a fleet with keys.
#include <gmock/gmock.h>
#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../common/TestMembers.h"
#include "../conformance/ForbiddenTopic.h"
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

// The forbidden writer is announced first, and keeps no other one from being heard.
TEST_F(CycloneDdsMembersTest, AMemberDeliversNothingOnATopicThatItsPermissionsLack)
{
    TestMembers fleet("fleet");
    const auto uav = Backend().Open(
        SettingsWith("uav1", fleet.Member("uav1", {{.Topic = "Pose", .MayWrite = true, .MayRead = true}})),
        {});
    const auto ground = Backend().Open(Settings("ground"), {});
    const BesideForbidden told = TalkBesideForbidden(Net(), *uav, *ground);
    ASSERT_TRUE(told.IsPoseHeard);
    EXPECT_EQ(told.Writers, 0);
    EXPECT_EQ(told.Heard, 0u);
}

TEST_F(CycloneDdsMembersTest, AMemberIsNotSentATopicThatItsPermissionsLack)
{
    TestMembers fleet("fleet");
    const auto uav = Backend().Open(Settings("uav1"), {});
    const auto tool =
        Backend().Open(SettingsWith("tool", fleet.Member("tool", {{.Topic = "Pose", .MayRead = true}})), {});
    const BesideForbidden told = TalkBesideForbidden(Net(), *uav, *tool);
    ASSERT_TRUE(told.IsPoseHeard);
    EXPECT_EQ(told.Readers, 0);
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

// The vendor reads from the sockets that send, too. A datagram that reached its parser would be no row.
TEST_F(CycloneDdsMembersTest, APlainDatagramToASocketThatSendsDoesNotPassByTheKeys)
{
    UdpTap peer(0, "");
    auto settings = Settings("uav1");
    settings.Multicast = false;
    settings.Peers = {"127.0.0.1:" + std::to_string(peer.Port())};
    const auto uav = Backend().Open(settings, {});
    ASSERT_TRUE(Net().Until([&] { return peer.Sealed() > 0; }));
    const std::vector<std::uint8_t> plain{'R', 'T', 'P', 'S', 2, 1, 1, 16, 1,  2,
                                          3,   4,   5,   6,   7, 8, 9, 10, 11, 12};
    EXPECT_TRUE(Net().Until(
        [&]
        {
            peer.Answer(plain);
            const auto rows = settings.Member->Problems();
            return std::any_of(rows.begin(), rows.end(),
                               [](const SettingsProblem &row)
                               { return row.Text.find("a program without keys") != std::string::npos; });
        }));
}

TEST_F(CycloneDdsMembersTest, APeerListedOnOneSideIsEnoughWhicheverStartsFirst)
{
    auto listed = Settings("uav1");
    auto listing = Settings("ground");
    listed.Multicast = false;
    listing.Multicast = false;
    listing.Peers = {"127.0.0.1"};
    ExpectDelivery(listed, listing);
    ExpectDelivery(listing, listed);
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

TEST_F(CycloneDdsMembersTest, AConfigurationThatHearsBeforeTheKeysAreThereIsRefused)
{
    ExpectRefusalWith("<Internal><ControlTopic><Deaf>false</Deaf></ControlTopic></Internal>");
}

TEST_F(CycloneDdsMembersTest, AConfigurationThatHearsByItselfLaterIsRefused)
{
    ExpectRefusalWith("<Internal><ControlTopic InitialReset=\"1ms\"/></Internal>");
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
