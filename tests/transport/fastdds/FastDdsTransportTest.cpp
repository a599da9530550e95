// What the Fast DDS backend makes of the settings that only a real network has.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <rabit/fastdds/FastDdsTransport.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"

namespace Rabit::Conformance
{

namespace
{

using testing::HasSubstr;
using Kind = PeerEvent::Kind;

class FastDdsTransportTest : public testing::Test
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

    std::string RefusalOf(const TransportSettings &settings)
    {
        try
        {
            Backend.Open(settings, {});
            return "not refused";
        }
        catch (const TransportError &error)
        {
            return error.what();
        }
    }

    // A file with that text, removed with the test.
    std::string TemporaryFile(const std::string &text)
    {
        _file = testing::TempDir() + "rabit-fastdds-" + std::to_string(getpid()) + ".xml";
        std::ofstream(_file) << text;
        return _file;
    }
    ~FastDdsTransportTest() override
    {
        if (!_file.empty())
        {
            std::filesystem::remove(_file);
        }
    }

    FastDdsTransport Backend;
    ProcessHarness Net{std::make_unique<FastDdsTransport>()};

private:
    std::string _file;
};

TEST_F(FastDdsTransportTest, AnUnknownInterfaceIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Interfaces = {"lo", "radio99"};
    EXPECT_THAT(RefusalOf(settings), HasSubstr("radio99"));
}

TEST_F(FastDdsTransportTest, AnImpossiblePeerIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.Peers = {"127.0.0.1:notaport"};
    EXPECT_THAT(RefusalOf(settings), HasSubstr("127.0.0.1:notaport"));
}

TEST_F(FastDdsTransportTest, AMissingProfilesFileIsRefusedByName)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = "/nowhere/profiles.xml";
    EXPECT_THAT(RefusalOf(settings), HasSubstr("/nowhere/profiles.xml"));
}

TEST_F(FastDdsTransportTest, ABrokenProfilesFileIsRefused)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<dds><profiles>");
    EXPECT_THAT(RefusalOf(settings), HasSubstr(settings.BackendConfig));
}

TEST_F(FastDdsTransportTest, AProfilesFileIsTheBaseOfTheSettings)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <profiles>
    <transport_descriptors>
      <transport_descriptor>
        <transport_id>loopback</transport_id>
        <type>UDPv4</type>
        <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList>
      </transport_descriptor>
    </transport_descriptors>
    <participant profile_name="base" is_default_profile="true">
      <rtps>
        <userTransports><transport_id>loopback</transport_id></userTransports>
        <useBuiltinTransports>false</useBuiltinTransports>
      </rtps>
    </participant>
  </profiles>
</dds>)");
    PeerRecorder peers;
    auto settingsOfPeer = Settings("ground");
    const auto ground = Backend.Open(settingsOfPeer, peers.Handler());
    // The transports are the file's: an interface that does not exist is not looked at.
    settings.Interfaces = {"radio99"};
    const auto uav = Backend.Open(settings, {});
    EXPECT_TRUE(Net.Until([&] { return peers.Count(Kind::Appeared, "uav1", 1) == 1; }));
}

TEST_F(FastDdsTransportTest, PeersFindEachOtherWithoutMulticast)
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

TEST_F(FastDdsTransportTest, APeerListedOnOneSideIsEnough)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Multicast = false;
    other.Multicast = false;
    other.Peers = {"localhost"};
    ExpectDelivery(one, other);
}

TEST_F(FastDdsTransportTest, AListOfPeersDoesNotEndMulticast)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.Peers = {"127.0.0.1:9"};
    other.Peers = {"127.0.0.1:9"};
    ExpectDelivery(one, other);
}

TEST_F(FastDdsTransportTest, LargeAndSmallDatagramsUnderstandEachOther)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.MaxDatagram = 65000;
    other.MaxDatagram = 1000;
    ExpectDelivery(one, other);
    ExpectDelivery(other, one);
}

TEST_F(FastDdsTransportTest, SharedMemoryDelivers)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.SharedMemory = true;
    other.SharedMemory = true;
    ExpectDelivery(one, other);
}

TEST_F(FastDdsTransportTest, ANodeNameOfFullLengthArrives)
{
    const std::string name(200, 'n');
    PeerRecorder peers;
    const auto ground = Backend.Open(Settings("ground"), peers.Handler());
    const auto uav = Backend.Open(Settings(name), {});
    EXPECT_TRUE(Net.Until([&] { return peers.Count(Kind::Appeared, name, 1) == 1; }));
}

// Bytes that are no RTPS message at all, or only begin like one.
TEST_F(FastDdsTransportTest, NoiseOnItsPortsDoesNotDisturbASession)
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
        if (i % 2 == 0 && bytes.size() >= 4)
        {
            std::copy_n("RTPS", 4, bytes.begin());
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
