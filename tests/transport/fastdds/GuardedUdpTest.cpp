// `GuardedUdp` between sockets and receivers of the vendor's that are not there.
#include "GuardedUdp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "guard/RtpsBytes.h"
#include "rtps/DiscoverySubmessages.h"

namespace
{

using namespace RtpsBytes;
using namespace Rabit::FastDds;
using Rabit::DiscoveryTurns;
using Rabit::Rtps::AuthenticationThread;
using Rabit::Rtps::RtpsGuard;

constexpr std::uint32_t GroupPort = 7400;
constexpr std::uint32_t DiscoveryPort = 7410;
constexpr std::uint32_t SamplesPort = 7411;
// Only keeps a broken test from hanging.
constexpr std::chrono::seconds Limit{60};

// Keeps what comes to one port.
class Port final : public rtps::TransportReceiverInterface
{
public:
    void OnDataReceived(const rtps::octet *data, std::uint32_t size, const rtps::Locator_t & /*local*/,
                        const rtps::Locator_t & /*remote*/) override
    {
        const std::lock_guard lock(_mutex);
        _datagrams.emplace_back(data, data + size);
        _changed.notify_all();
    }
    bool WaitFor(const Bytes &datagram)
    {
        std::unique_lock lock(_mutex);
        return _changed.wait_for(lock, Limit, [&] { return std::ranges::count(_datagrams, datagram) > 0; });
    }
    std::size_t Count()
    {
        const std::lock_guard lock(_mutex);
        return _datagrams.size();
    }

private:
    std::mutex _mutex;
    std::condition_variable _changed;
    std::vector<Bytes> _datagrams;
};

rtps::Locator_t At(std::uint32_t port)
{
    rtps::Locator_t locator;
    rtps::IPLocator::setIPv4(locator, "127.0.0.1");
    locator.port = port;
    return locator;
}

std::shared_ptr<AuthenticationThread> ThatGivesUpSoon()
{
    return std::make_shared<AuthenticationThread>(true, std::chrono::milliseconds(20));
}

// With keys.
class GuardedUdpTest : public testing::Test
{
protected:
    GuardedUdpTest()
    {
        _udp->init();
        _udp->OpenOutputChannel(_sockets, At(DiscoveryPort));
        // Sent to nobody: the transport learns the own name and ports.
        Own->Send(*_sockets.front(), ParticipantMessage(Other, DiscoveryPort), _nobody, _nobody,
                  std::chrono::steady_clock::now() + Limit);
    }
    void Receive(Port &to, std::uint32_t port, Bytes datagram)
    {
        Own->receive(&to, datagram.data(), static_cast<std::uint32_t>(datagram.size()), At(port), At(1234));
    }

private:
    static GuardedUdpDescriptor::Settings Secured()
    {
        GuardedUdpDescriptor::Settings settings;
        settings.MaxDatagram = 1400;
        settings.Mode = RtpsGuard::Mode::Protected;
        settings.GroupPort = GroupPort;
        settings.OnDropped = [] {};
        settings.OnSent = [](bool, std::size_t, std::size_t) {};
        settings.Announce = [] {};
        settings.AnnouncementPeriod = std::chrono::seconds(1);
        settings.AnnounceAt = [](std::chrono::steady_clock::time_point) {};
        settings.Keys = std::make_shared<KeyThread>(std::make_shared<DiscoveryTurns>(), settings.MaxDatagram);
        settings.Authentication = ThatGivesUpSoon();
        return settings;
    }

    const std::shared_ptr<rtps::UDPv4TransportDescriptor> _udpDescriptor =
        std::make_shared<rtps::UDPv4TransportDescriptor>();
    const std::unique_ptr<rtps::TransportInterface> _udp{_udpDescriptor->create_transport()};
    rtps::SendResourceList _sockets;
    rtps::LocatorList _noLocators;
    rtps::Locators _nobody{_noLocators.begin()};
    const GuardedUdpDescriptor _descriptor{_udpDescriptor, Secured()};

protected:
    Port Discovery;
    Port Samples;
    const std::unique_ptr<ChainedUdp> Own{static_cast<ChainedUdp *>(_descriptor.create_transport())};
};

TEST_F(GuardedUdpTest, AGoodbyeThatIsMadeHereGoesWhereTheVendorTakesDiscovery)
{
    Receive(Discovery, DiscoveryPort, ParticipantMessage(Sender));
    Receive(Samples, SamplesPort, Message(Data, DataBody(1), 5));
    EXPECT_TRUE(Discovery.WaitFor(Rabit::Rtps::GoodbyeOf(Sender, ParticipantMessage(Other), 2)));
    EXPECT_EQ(Samples.Count(), 0u);
}

TEST_F(GuardedUdpTest, TheGroupThatIsNotAnnouncedIsForDiscovery)
{
    Receive(Discovery, GroupPort, ParticipantMessage(Sender));
    Receive(Samples, SamplesPort, Message(Data, DataBody(1), 5));
    EXPECT_TRUE(Discovery.WaitFor(Rabit::Rtps::GoodbyeOf(Sender, ParticipantMessage(Other), 2)));
}

}  // namespace
