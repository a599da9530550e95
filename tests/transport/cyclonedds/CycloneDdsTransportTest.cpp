// What the Cyclone DDS backend makes of the settings that only a real network has.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <rabit/cyclonedds/CycloneDdsTransport.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"

namespace Rabit::Conformance
{

namespace
{

using testing::HasSubstr;
using testing::Not;
using Kind = PeerEvent::Kind;

class CycloneDdsTransportTest : public testing::Test
{
protected:
    TransportSettings Settings(const std::string &node) { return Net.SettingsFor(node, 1); }

    // That a sample crosses between two sessions with these settings.
    void ExpectDelivery(const TransportSettings &one, const TransportSettings &other)
    {
        SampleRecorder recorder;
        const auto writing = Backend.Open(one, {});
        const auto reading = Backend.Open(other, {});
        const auto writer = writing->CreateWriter(TextTopic(), State(), {});
        const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, std::string(5000, 'x')), 1), WriteResult::Ok);
        ASSERT_TRUE(Net.Until([&] { return recorder.Count() == 1; }));
        EXPECT_EQ(recorder.Texts()[0], std::string(5000, 'x'));
    }

    TransportError RefusalOf(const TransportSettings &settings)
    {
        try
        {
            Backend.Open(settings, {});
            return TransportError("not refused");
        }
        catch (const TransportError &error)
        {
            EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
            return error;
        }
    }

    // A file with that text, removed with the test.
    std::string TemporaryFile(const std::string &text)
    {
        _file = testing::TempDir() + "rabit-cyclonedds-" + std::to_string(getpid()) + ".xml";
        std::ofstream(_file) << text;
        return _file;
    }
    ~CycloneDdsTransportTest() override
    {
        if (!_file.empty())
        {
            std::filesystem::remove(_file);
        }
    }

    CycloneDdsTransport Backend;
    ProcessHarness Net{std::make_unique<CycloneDdsTransport>()};

private:
    std::string _file;
};

TEST_F(CycloneDdsTransportTest, AnUnknownInterfaceIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Interfaces = {"lo", "radio99"};
    const auto refusal = RefusalOf(settings);
    EXPECT_THAT(refusal.what(), HasSubstr("radio99"));
    EXPECT_EQ(refusal.Setting(), "interfaces");
}

TEST_F(CycloneDdsTransportTest, AnImpossiblePeerIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Peers = {"127.0.0.1:notaport"};
    const auto refusal = RefusalOf(settings);
    EXPECT_THAT(refusal.what(), HasSubstr("127.0.0.1:notaport"));
    EXPECT_EQ(refusal.Setting(), "peers");
}

TEST_F(CycloneDdsTransportTest, AMissingConfigurationFileIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = "/nowhere/cyclonedds.xml";
    const auto refusal = RefusalOf(settings);
    EXPECT_THAT(refusal.what(), HasSubstr("/nowhere/cyclonedds.xml"));
    EXPECT_EQ(refusal.Setting(), "backend_config");
}

TEST_F(CycloneDdsTransportTest, ABrokenConfigurationFileIsRefusedWithTheVendorsReason)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"any\"><Generl/></Domain></CycloneDDS>");
    const auto refusal = RefusalOf(settings);
    EXPECT_THAT(refusal.what(), HasSubstr(settings.BackendConfig));
    EXPECT_THAT(refusal.what(), HasSubstr("Generl"));
    EXPECT_EQ(refusal.Setting(), "backend_config");
}

TEST_F(CycloneDdsTransportTest, ARefusedSessionLeavesTheDomainFree)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"any\"><Generl/></Domain></CycloneDDS>");
    RefusalOf(settings);
    RefusalOf(settings);
    ExpectDelivery(Settings("uav1"), Settings("ground"));
}

// A file that forbids all discovery by multicast shows by what it does not let happen that it is applied.
TEST_F(CycloneDdsTransportTest, AConfigurationFileIsLaidOverTheSettings)
{
    auto deaf = Settings("uav1");
    deaf.BackendConfig = TemporaryFile(
        "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false</AllowMulticast>"
        "</General></Domain></CycloneDDS>");
    PeerRecorder atDeaf;
    PeerRecorder atOther;
    const auto one = Backend.Open(deaf, atDeaf.Handler());
    const auto other = Backend.Open(Settings("ground"), atOther.Handler());
    const auto third = Backend.Open(Settings("uav3"), {});
    ASSERT_TRUE(Net.Until([&] { return atOther.Count(Kind::Appeared, "uav3", 1) == 1; }));
    Net.Settle();
    EXPECT_EQ(atDeaf.CountAll(), 0u);
    EXPECT_EQ(atOther.Count(Kind::Appeared, "uav1", 1), 0);
}

TEST_F(CycloneDdsTransportTest, AConfigurationFileMayNameTheDomain)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"" + std::to_string(settings.Domain) +
                                           "\"><Generl/></Domain></CycloneDDS>");
    EXPECT_THAT(RefusalOf(settings).what(), HasSubstr("Generl"));
}

TEST_F(CycloneDdsTransportTest, PeersFindEachOtherWithoutMulticast)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    for (auto *settings : {&one, &other})
    {
        settings->Multicast = false;
        settings->Peers = {"127.0.0.1"};
    }
    ExpectDelivery(one, other);
}

TEST_F(CycloneDdsTransportTest, APeerListedOnOneSideIsEnough)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Multicast = false;
    other.Multicast = false;
    other.Peers = {"localhost"};
    ExpectDelivery(one, other);
}

TEST_F(CycloneDdsTransportTest, AListOfPeersDoesNotEndMulticast)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Peers = {"127.0.0.1:9"};
    other.Peers = {"127.0.0.1:9"};
    ExpectDelivery(one, other);
}

TEST_F(CycloneDdsTransportTest, LargeAndSmallDatagramsUnderstandEachOther)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.MaxDatagram = 65000;
    other.MaxDatagram = 1000;
    ExpectDelivery(one, other);
    ExpectDelivery(other, one);
}

TEST_F(CycloneDdsTransportTest, SessionsOfOneProcessInSeveralDomainsDoNotHearEachOther)
{
    const DomainLease elsewhere;
    PeerRecorder here;
    auto settings = Settings("ground");
    const auto ground = Backend.Open(settings, here.Handler());
    settings.Node = "stranger";
    settings.Domain = elsewhere.Domain();
    const auto stranger = Backend.Open(settings, {});
    const auto uav = Backend.Open(Settings("uav1"), {});
    ASSERT_TRUE(Net.Until([&] { return here.Count(Kind::Appeared, "uav1", 1) == 1; }));
    Net.Settle();
    EXPECT_EQ(here.Count(Kind::Appeared, "stranger", 1), 0);
}

TEST_F(CycloneDdsTransportTest, TwentySessionsOfOneHostFindEachOther)
{
    PeerRecorder peers;
    std::vector<std::unique_ptr<TransportSession>> sessions;
    sessions.push_back(Backend.Open(Settings("ground"), peers.Handler()));
    for (int i = 1; i <= 20; ++i)
    {
        sessions.push_back(Backend.Open(Settings("uav" + std::to_string(i)), {}));
    }
    for (int i = 1; i <= 20; ++i)
    {
        EXPECT_TRUE(Net.Until([&] { return peers.Count(Kind::Appeared, "uav" + std::to_string(i), 1) == 1; }))
            << i;
    }
}

TEST_F(CycloneDdsTransportTest, ANodeNameOfFullLengthArrives)
{
    const std::string name(200, 'n');
    PeerRecorder peers;
    const auto ground = Backend.Open(Settings("ground"), peers.Handler());
    const auto uav = Backend.Open(Settings(name), {});
    EXPECT_TRUE(Net.Until([&] { return peers.Count(Kind::Appeared, name, 1) == 1; }));
}

// The other side takes the topic for one without a key, and sends no key hash with a body too short to have
// one.
TEST_F(CycloneDdsTransportTest, ASampleWithoutAReadableKeyIsCountedWhereItArrives)
{
    TopicDescription keyed = KeyedTopic();
    TopicDescription liar = keyed;
    liar.KeyOf = [](SampleBytes, KeyHash &) { return true; };
    keyed.KeyOf = [](SampleBytes, KeyHash &) { return false; };
    auto withoutHash = Settings("uav1");
    withoutHash.BackendConfig = TemporaryFile(
        "<CycloneDDS><Domain Id=\"any\"><Internal><GenerateKeyhash>false"
        "</GenerateKeyhash></Internal></Domain></CycloneDDS>");
    const auto writing = Backend.Open(withoutHash, {});
    const auto reading = Backend.Open(Settings("ground"), {});
    SampleRecorder recorder;
    const auto writer = writing->CreateWriter(liar, State(), {});
    const auto reader = reading->CreateReader(keyed, State(), {}, recorder.Handler());
    ASSERT_EQ(WriteOnceTaken(*writer, RawSample({1, 2, 3}), 1), WriteResult::Ok);
    EXPECT_TRUE(Net.Until([&] { return reading->Counters().MalformedSamples > 0; }));
    EXPECT_EQ(recorder.Count(), 0u);
}

// Bytes that are no RTPS message at all, or only begin like one.
TEST_F(CycloneDdsTransportTest, NoiseOnItsPortsDoesNotDisturbASession)
{
    SampleRecorder recorder;
    const auto writing = Backend.Open(Settings("uav1"), {});
    const auto reading = Backend.Open(Settings("ground"), {});
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    const auto reader = reading->CreateReader(TextTopic(), Stream(10), {}, recorder.Handler());
    ASSERT_TRUE(Net.Until([&] { return writer->MatchedReaders() == 1 && reader->MatchedWriters() == 1; }));
    const int noise = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(noise, 0);
    std::mt19937 random(1);
    const int firstPort = 7400 + 250 * Settings("").Domain;  // RTPS 2.3, 9.6.1.1
    for (int i = 0; i < 20000; ++i)
    {
        std::vector<std::uint8_t> bytes(random() % 200);
        for (auto &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(random());
        }
        if (i % 2 == 0 && bytes.size() >= 6)
        {
            std::copy_n("RTPS\2\1", 6, bytes.begin());
        }
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(static_cast<std::uint16_t>(firstPort + 10 + i % 40));
        sendto(noise, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&to), sizeof to);
    }
    close(noise);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "still here"), 1), WriteResult::Ok);
    EXPECT_TRUE(Net.Until([&] { return recorder.Count() == 1; }));
    EXPECT_TRUE(Net.Until([&] { return writing->Counters().MalformedDatagrams > 0; }));
}

}  // namespace

}  // namespace Rabit::Conformance
