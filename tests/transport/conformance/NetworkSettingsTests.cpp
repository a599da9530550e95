#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <random>
#include <string_view>
#include <vector>

#include "NetworkSettings.h"
#include "Recorder.h"
#include "TestSample.h"

namespace Rabit::Conformance
{

namespace
{

using Kind = PeerEvent::Kind;

// Sends datagrams to the ports of this domain on this host. They are no RTPS messages, or only begin like
// one.
void SendNoise(int domain)
{
    constexpr std::string_view beginnings[] = {"", "RTPS", "RTPS\2\1"};
    const int noise = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(noise, 0);
    std::mt19937 random(1);
    const int firstPort = 7400 + 250 * domain;  // RTPS 2.3, 9.6.1.1
    for (int i = 0; i < 20000; ++i)
    {
        std::vector<std::uint8_t> bytes(random() % 200);
        for (auto &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(random());
        }
        const std::string_view beginning = beginnings[random() % std::size(beginnings)];
        std::copy_n(beginning.begin(), std::min(beginning.size(), bytes.size()), bytes.begin());
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(static_cast<std::uint16_t>(firstPort + 10 + i % 40));
        sendto(noise, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&to), sizeof to);
    }
    close(noise);
}

TEST_P(NetworkSettings, AnUnknownInterfaceIsWaitedForAndToldByName)
{
    auto settings = Settings("uav1");
    settings.Interfaces = {"radio99"};
    const auto session = Backend().Open(settings, {});
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Setting, "interfaces");
    EXPECT_EQ(problems[0].Entry, "radio99");
    EXPECT_EQ(problems[0].Text, "the interface radio99 does not exist: waiting for it");
    EXPECT_FALSE(problems[0].Impossible);
    const auto writer = session->CreateWriter(TextTopic(), Stream(10), {});
    EXPECT_EQ(writer->Write(MakeSample(0, "to nobody"), 1), WriteResult::TimedOut);
    EXPECT_THROW(session->CreateWriter({TextTopic().Name, "Another", {}}, Stream(10), {}), TransportError);
}

TEST_P(NetworkSettings, AnUnknownInterfaceBesideAnotherKeepsNothingBack)
{
    auto one = Settings("uav1");
    one.Interfaces = {"radio99", "lo"};
    ExpectDelivery(one, Settings("ground"));
}

TEST_P(NetworkSettings, AnInterfaceThatCanBeNoneIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Interfaces = {"lo", "radio/99"};
    ExpectRefusal(settings, "radio/99", "interfaces");
}

TEST_P(NetworkSettings, APeerWithoutAnAddressIsToldByNameAndKeepsNothingBack)
{
    auto one = Settings("uav1");
    one.Peers = {"no-such-host.invalid:7410"};
    const auto session = Backend().Open(one, {});
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Setting, "peers");
    EXPECT_EQ(problems[0].Entry, "no-such-host.invalid:7410");
    ExpectDelivery(one, Settings("ground"));
}

TEST_P(NetworkSettings, GoodSettingsPassTheCheck)
{
    auto settings = Settings("uav1");
    settings.Peers = {"127.0.0.1", "localhost:7410"};
    // A check waits a second for a name, which may not be looked up by then.
    EXPECT_TRUE(Net().Until([&] { return Backend().Check(settings).empty(); }));
}

TEST_P(NetworkSettings, TheCheckTellsWhatIsMissingFromWhatIsImpossible)
{
    auto settings = Settings("uav1");
    settings.Interfaces = {"radio99"};
    settings.Peers = {"no-such-host.invalid"};
    const auto missing = Backend().Check(settings);
    ASSERT_EQ(missing.size(), 2u);
    EXPECT_EQ(missing[0].Entry, "radio99");
    EXPECT_FALSE(missing[0].Impossible);
    EXPECT_EQ(missing[1].Entry, "no-such-host.invalid");
    EXPECT_FALSE(missing[1].Impossible);
    settings.Interfaces = {"radio/99"};
    settings.Peers = {"127.0.0.1:notaport"};
    const auto impossible = Backend().Check(settings);
    ASSERT_EQ(impossible.size(), 2u);
    EXPECT_EQ(impossible[0].Setting, "interfaces");
    EXPECT_TRUE(impossible[0].Impossible);
    EXPECT_EQ(impossible[1].Setting, "peers");
    EXPECT_TRUE(impossible[1].Impossible);
}

TEST_P(NetworkSettings, TheCheckRefusesABadConfigurationFile)
{
    auto settings = Settings("uav1");
    for (const std::string &file : {std::string("/nowhere/vendor.xml"), TemporaryFile("<dds><profiles>")})
    {
        settings.BackendConfig = file;
        const auto problems = Backend().Check(settings);
        ASSERT_EQ(problems.size(), 1u) << file;
        EXPECT_EQ(problems[0].Setting, "backend_config");
        EXPECT_NE(problems[0].Text.find(file), std::string::npos) << problems[0].Text;
        EXPECT_TRUE(problems[0].Impossible);
    }
}

TEST_P(NetworkSettings, AnImpossiblePeerIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Peers = {"127.0.0.1:notaport"};
    ExpectRefusal(settings, "127.0.0.1:notaport", "peers");
}

TEST_P(NetworkSettings, AMissingConfigurationFileIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = "/nowhere/vendor.xml";
    ExpectRefusal(settings, "/nowhere/vendor.xml", "backend_config");
}

TEST_P(NetworkSettings, ABrokenConfigurationFileIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<dds><profiles>");
    ExpectRefusal(settings, settings.BackendConfig, "backend_config");
}

TEST_P(NetworkSettings, PeersFindEachOtherWithoutMulticast)
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

TEST_P(NetworkSettings, APeerListedOnOneSideIsEnough)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Multicast = false;
    other.Multicast = false;
    other.Peers = {"localhost"};
    ExpectDelivery(one, other);
}

// The card of the other node has been sent before, and does not change any more: it has to be asked for.
TEST_P(NetworkSettings, ANodeThatIsListedMayStartLater)
{
    auto listed = Settings("uav1");
    auto listing = Settings("ground");
    listed.Multicast = false;
    listing.Multicast = false;
    listing.Peers = {"localhost"};
    SampleRecorder recorder;
    const auto writing = Backend().Open(listing, {});
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    const auto reading = Backend().Open(listed, {});
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    EXPECT_TRUE(Net().Until(
        [&]
        {
            WriteOnceTaken(*writer, MakeSample(0, "text"), 1);
            return recorder.Count() > 0;
        }));
}

// More sessions have come and gone than ports are tried for a peer without a port.
TEST_P(NetworkSettings, ASessionThatIsClosedLeavesItsPortToTheNext)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    for (auto *settings : {&one, &other})
    {
        settings->Multicast = false;
        settings->Peers = {"127.0.0.1"};
    }
    for (int i = 0; i < 20; ++i)
    {
        Backend().Open(one, {});
    }
    ExpectDelivery(one, other);
}

TEST_P(NetworkSettings, AListOfPeersDoesNotEndMulticast)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Peers = {"127.0.0.1:9"};
    other.Peers = {"127.0.0.1:9"};
    ExpectDelivery(one, other);
}

TEST_P(NetworkSettings, LargeAndSmallDatagramsUnderstandEachOther)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.MaxDatagram = 65000;
    other.MaxDatagram = 1000;
    ExpectDelivery(one, other);
    ExpectDelivery(other, one);
}

TEST_P(NetworkSettings, ANodeNameOfFullLengthArrives)
{
    const std::string name(200, 'n');
    PeerRecorder peers;
    const auto ground = Backend().Open(Settings("ground"), peers.Handler());
    const auto uav = Backend().Open(Settings(name), {});
    EXPECT_TRUE(Net().Until([&] { return peers.Count(Kind::Appeared, name, 1) == 1; }));
}

TEST_P(NetworkSettings, NoiseOnItsPortsDoesNotDisturbASession)
{
    SampleRecorder recorder;
    const auto writing = Backend().Open(Settings("uav1"), {});
    const auto reading = Backend().Open(Settings("ground"), {});
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    const auto reader = reading->CreateReader(TextTopic(), Stream(10), {}, recorder.Handler());
    ASSERT_TRUE(Net().Until([&] { return writer->MatchedReaders() == 1 && reader->MatchedWriters() == 1; }));
    ASSERT_NO_FATAL_FAILURE(SendNoise(Settings("").Domain));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "still here"), 1), WriteResult::Ok);
    EXPECT_TRUE(Net().Until([&] { return recorder.Count() == 1; }));
    EXPECT_TRUE(Net().Until([&] { return writing->Counters().MalformedDatagrams > 0; }));
}

}  // namespace

}  // namespace Rabit::Conformance
