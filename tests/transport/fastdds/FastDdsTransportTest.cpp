// The Fast DDS backend and the settings that only a real network has.
#include <rabit/fastdds/FastDdsTransport.h>

#include <memory>
#include <string>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "../conformance/NetworkSettings.h"
#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"

namespace Rabit::Conformance
{

namespace
{

using Kind = PeerEvent::Kind;

std::unique_ptr<TransportHarness> MakeHarness()
{
    return std::make_unique<ProcessHarness>(std::make_unique<FastDdsTransport>());
}

class FastDdsTransportTest : public testing::Test, protected NetworkFixture
{
protected:
    FastDdsTransportTest() : NetworkFixture(MakeHarness()) {}
};

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
    const auto ground = Backend().Open(settingsOfPeer, peers.Handler());
    // The file sets the transports, so an interface that does not exist does not matter.
    settings.Interfaces = {"radio99"};
    const auto uav = Backend().Open(settings, {});
    EXPECT_TRUE(Net().Until([&] { return peers.Count(Kind::Appeared, "uav1", 1) == 1; }));
}

TEST_F(FastDdsTransportTest, ASessionDoesNotBeginDeafIfAnotherProgramHasThePortOfDiscovery)
{
    const auto settings = Settings("uav1");
    const int port = 7400 + 250 * settings.Domain;
    const int holder = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    ASSERT_EQ(::bind(holder, reinterpret_cast<const sockaddr *>(&address), sizeof address), 0);
    try
    {
        Backend().Open(settings, {});
        ADD_FAILURE() << "it began";
    }
    catch (const TransportError &error)
    {
        EXPECT_EQ(error.Setting(), "domain");
        EXPECT_NE(std::string(error.what()).find("UDP port " + std::to_string(port) + ","), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find("another program has it"), std::string::npos)
            << error.what();
    }
    ::close(holder);
    EXPECT_NO_THROW(Backend().Open(settings, {}));
}

TEST_F(FastDdsTransportTest, SharedMemoryDelivers)
{
    auto one = Settings("uav1");
    auto other = Settings("ground");
    one.SharedMemory = true;
    other.SharedMemory = true;
    ExpectDelivery(one, other);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(FastDds, NetworkSettings, testing::Values(HarnessMaker{"fastdds", &MakeHarness}));

}  // namespace Rabit::Conformance
