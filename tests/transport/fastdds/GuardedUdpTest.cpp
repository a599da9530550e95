// `GuardedUdp` between sockets and receivers of the vendor's that are not there.
#include "GuardedUdp.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "../../Eventually.h"
#include "../common/TestMembers.h"
#include "ParticipantSettings.h"
#include "common/SessionLog.h"
#include "envelope/Outer.h"
#include "envelope/SealedSession.h"
#include "envelope/Sealer.h"
#include "guard/RtpsBytes.h"
#include "guard/RtpsMessage.h"

namespace
{

using namespace RtpsBytes;
using namespace Rabit::FastDds;
using Rabit::Rtps::StatisticsSize;
using Rabit::Rtps::SubmessageHeaderSize;

constexpr std::uint32_t GroupPort = 7400;
constexpr std::uint32_t DiscoveryPort = 7410;

// Counts what comes to one port.
class Port final : public rtps::TransportReceiverInterface
{
public:
    void OnDataReceived(const rtps::octet * /*data*/, std::uint32_t /*size*/,
                        const rtps::Locator_t & /*local*/, const rtps::Locator_t & /*remote*/) override
    {
        ++_count;
    }
    std::size_t Count() const { return _count; }

private:
    std::size_t _count = 0;
};

// A socket of this machine.
class Receiving
{
public:
    Receiving()
    {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(address);
        auto *const any = reinterpret_cast<sockaddr *>(&address);
        const timeval limit{.tv_sec = RabitTest::Hangs.count(), .tv_usec = 0};
        EXPECT_EQ(setsockopt(_socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit)), 0);
        EXPECT_EQ(bind(_socket, any, size), 0);
        EXPECT_EQ(getsockname(_socket, any, &size), 0);
        _port = ntohs(address.sin_port);
    }
    ~Receiving() { close(_socket); }
    Receiving(const Receiving &) = delete;
    Receiving &operator=(const Receiving &) = delete;
    std::uint32_t Port() const { return _port; }
    // A datagram that comes behind all that was sent to this socket before.
    static inline const Bytes Fence{1, 2, 3};
    void SendFence() const
    {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(_port));
        EXPECT_EQ(sendto(_socket, Fence.data(), Fence.size(), 0, reinterpret_cast<sockaddr *>(&address),
                         sizeof(address)),
                  static_cast<ssize_t>(Fence.size()));
    }
    // The next datagram; empty if none comes.
    Bytes Next()
    {
        Bytes datagram(65536);
        const auto size = recv(_socket, datagram.data(), datagram.size(), 0);
        datagram.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
        return datagram;
    }

private:
    const int _socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    std::uint32_t _port = 0;
};

rtps::Locator_t At(std::uint32_t port)
{
    rtps::Locator_t locator;
    rtps::IPLocator::setIPv4(locator, "127.0.0.1");
    locator.port = port;
    return locator;
}

class UdpTest : public testing::Test
{
protected:
    explicit UdpTest(GuardedUdpDescriptor::Settings settings)
        : _descriptor(_udpDescriptor, std::move(settings))
    {
        _udp->init();
        _udp->OpenOutputChannel(_sockets, At(DiscoveryPort));
        // Sent to nobody: the transport learns the own name and ports.
        Own->Send(*_sockets.front(), ParticipantMessage(Other, DiscoveryPort), _nobody, _nobody,
                  RabitTest::WhenItHangs());
    }
    // The vendor's statistics know only destinations that were named before.
    void Name(std::uint32_t port) { _udp->OpenOutputChannel(_sockets, At(port)); }
    void Send(const Bytes &datagram, std::uint32_t port)
    {
        Name(port);
        rtps::LocatorList list;
        list.push_back(At(port));
        rtps::Locators begin(list.begin());
        rtps::Locators end(list.end());
        Own->Send(*_sockets.front(), datagram, begin, end, RabitTest::WhenItHangs());
    }
    void Receive(Port &to, std::uint32_t port, Bytes datagram)
    {
        Own->receive(&to, datagram.data(), static_cast<std::uint32_t>(datagram.size()), At(port), At(1234));
    }

    static GuardedUdpDescriptor::Settings Common()
    {
        GuardedUdpDescriptor::Settings settings;
        settings.MaxDatagram = 1400;
        settings.GroupPort = GroupPort;
        settings.OnDropped = [] {};
        settings.OnSent = [](bool, std::size_t, std::size_t) {};
        settings.Announce = [] {};
        settings.AnnouncementPeriod = std::chrono::seconds(1);
        settings.AnnounceAt = [](std::chrono::steady_clock::time_point) {};
        return settings;
    }

private:
    const std::shared_ptr<rtps::UDPv4TransportDescriptor> _udpDescriptor =
        std::make_shared<rtps::UDPv4TransportDescriptor>();
    const std::unique_ptr<rtps::TransportInterface> _udp{_udpDescriptor->create_transport()};
    rtps::SendResourceList _sockets;
    rtps::LocatorList _noLocators;
    rtps::Locators _nobody{_noLocators.begin()};
    const GuardedUdpDescriptor _descriptor;

protected:
    Port Discovery;
    const std::shared_ptr<Rabit::SendingTurn> Turn = _descriptor.Chosen().Sending;
    const std::unique_ptr<ChainedUdp> Own{static_cast<ChainedUdp *>(_descriptor.create_transport())};
};

// Without keys, and this machine is a listed peer.
class GuardedUdpTest : public UdpTest
{
protected:
    GuardedUdpTest() : UdpTest(WithPeer()) {}

private:
    static GuardedUdpDescriptor::Settings WithPeer()
    {
        GuardedUdpDescriptor::Settings settings = Common();
        settings.Accounts = std::make_shared<Rabit::Rtps::Ledger>(
            std::set<Rabit::Rtps::HostAddress>{Rabit::Rtps::HostAddress{127, 0, 0, 1}});
        return settings;
    }
};

// With a member of a fleet, which has met nobody.
class SealedUdpTest : public UdpTest
{
protected:
    SealedUdpTest() : SealedUdpTest(std::make_shared<Sockets>()) {}

    static Bytes Sample(std::int64_t number, std::size_t size = 100)
    {
        return Join({Header(Other), Submessage(Data, DataBody(number, Bytes(size)), 5)});
    }
    std::size_t SentBytes() const { return _shared->SentBytes; }
    // At the port at which another node takes discovery data.
    Receiving &Usual() { return _shared->Usual; }

private:
    struct Sockets
    {
        std::size_t SentBytes = 0;
        Receiving Usual;
    };

    explicit SealedUdpTest(const std::shared_ptr<Sockets> &sockets)
        : UdpTest(Sealed(sockets)), _shared(sockets)
    {
        Name(_shared->Usual.Port());
    }
    static GuardedUdpDescriptor::Settings Sealed(const std::shared_ptr<Sockets> &sockets)
    {
        GuardedUdpDescriptor::Settings settings = Common();
        settings.Seal = std::make_shared<Rabit::Envelope::SealedSession>(
            Rabit::Conformance::TestMembers().Member("uav1"));
        const Bytes header = Header(Other);
        std::copy(header.begin(), header.end(), settings.Header.begin());
        settings.OnSent = [sockets](bool, std::size_t, std::size_t bytes) { sockets->SentBytes += bytes; };
        settings.DiscoveryPorts = {static_cast<std::uint16_t>(sockets->Usual.Port())};
        return settings;
    }

    const std::shared_ptr<Sockets> _shared;
};

TEST_F(GuardedUdpTest, WhatIsSoundReachesTheVendor)
{
    Receive(Discovery, DiscoveryPort, ParticipantMessage(Sender));
    EXPECT_EQ(Discovery.Count(), 1u);
}

// The vendor's socket writes its statistics into the end of what looks like them.
TEST_F(GuardedUdpTest, ASampleThatEndsLikeStatisticsArrivesAsItWasWritten)
{
    Bytes sample = Message(Data, DataBody(1, Bytes(100)), 5);
    sample[sample.size() - StatisticsSize] = Statistics;
    Receiving socket;
    Send(Join({sample, Submessage(Statistics, Bytes(StatisticsSize - SubmessageHeaderSize))}), socket.Port());
    const Bytes received = socket.Next();
    ASSERT_GE(received.size(), sample.size());
    EXPECT_TRUE(std::equal(sample.begin(), sample.end(), received.begin()));
}

TEST_F(GuardedUdpTest, SamplesOfATurnGoToEachPortInOneDatagramAtItsEnd)
{
    Receiving here;
    Receiving there;
    const Bytes body = Submessage(Data, DataBody(2), 5);
    ASSERT_TRUE(Turn->Begin(1000));
    Send(Message(Data, DataBody(1), 5), here.Port());
    Send(Message(Data, DataBody(1), 5), there.Port());
    Send(Join({Header(), body}), here.Port());
    here.SendFence();
    EXPECT_EQ(here.Next(), Receiving::Fence) << "nothing went before the end";
    Turn->End();
    EXPECT_EQ(here.Next(), Join({Message(Data, DataBody(1), 5), body}));
    EXPECT_EQ(there.Next(), Message(Data, DataBody(1), 5));
    Send(Join({Header(), body}), here.Port());
    EXPECT_EQ(here.Next(), Join({Header(), body})) << "after the turn";
}

// Each of the two does not end like statistics, but both together do.
TEST_F(GuardedUdpTest, SamplesOfATurnArriveAsTheyWereWrittenIfTogetherTheyEndLikeStatistics)
{
    const Bytes beat = Submessage(Heartbeat, HeartbeatBody(1, 1, 1));
    Bytes sample = Message(Data, DataBody(1, Bytes(100)), 5);
    sample[sample.size() + beat.size() - StatisticsSize] = Statistics;
    Receiving socket;
    ASSERT_TRUE(Turn->Begin(1000));
    Send(sample, socket.Port());
    Send(Join({Header(), beat}), socket.Port());
    Turn->End();
    const Bytes whole = Join({sample, beat});
    const Bytes received = socket.Next();
    ASSERT_GT(received.size(), whole.size());
    EXPECT_TRUE(std::equal(whole.begin(), whole.end(), received.begin()));
}

TEST_F(SealedUdpTest, NothingOfAnAnnouncementCanBeReadOnTheWire)
{
    Receiving socket;
    Send(WriterMessage(UserWriter, 1, Other), socket.Port());
    const Bytes received = socket.Next();
    EXPECT_GT(received.size(), WriterMessage(UserWriter, 1, Other).size());
    for (const std::string_view text : {"RTPS", "Pose", "uav1"})
    {
        EXPECT_EQ(std::search(received.begin(), received.end(), text.begin(), text.end()), received.end())
            << text;
    }
}

// Other builds of the vendor have another minor version.
TEST_F(SealedUdpTest, DatagramsOfAnotherMinorVersionAreSealed)
{
    Receiving socket;
    Bytes sample = Sample(1);
    sample[5] = 2;
    Send(sample, socket.Port());
    EXPECT_GT(socket.Next().size(), sample.size());
}

TEST_F(SealedUdpTest, EachDestinationGetsADatagramOfItsOwn)
{
    Receiving here;
    Receiving there;
    Send(Sample(1), here.Port());
    Send(Sample(1), there.Port());
    EXPECT_NE(here.Next(), there.Next());
}

TEST_F(SealedUdpTest, TheBytesThatAreSentAreCounted)
{
    Receiving socket;
    Send(Sample(1), socket.Port());
    EXPECT_EQ(socket.Next().size(), SentBytes());
}

TEST_F(SealedUdpTest, SamplesOfATurnAreSealedOnceAsOneDatagramThatIsNotTooLarge)
{
    constexpr std::size_t most = 600;
    Receiving socket;
    ASSERT_TRUE(Turn->Begin(most));
    for (std::int64_t number = 1; number <= 4; ++number)
    {
        Send(Sample(number), socket.Port());
    }
    Turn->End();
    const Bytes first = socket.Next();
    const Bytes second = socket.Next();
    EXPECT_GT(first.size(), 2 * Sample(1).size());
    EXPECT_LE(first.size(), most);
    EXPECT_EQ(first.size() + second.size(), SentBytes());
}

TEST_F(SealedUdpTest, StatisticsOfTheVendorAreNotSealed)
{
    Receiving socket;
    const Bytes statistics = Submessage(Statistics, Bytes(StatisticsSize - SubmessageHeaderSize));
    Send(Join({Sample(1), statistics}), socket.Port());
    EXPECT_LE(socket.Next().size(), Sample(1).size() + Rabit::Envelope::Sealer::MostAdded);
}

TEST_F(SealedUdpTest, NothingThatIsNotSealedReachesTheVendor)
{
    Receive(Discovery, DiscoveryPort, ParticipantMessage(Sender));
    Receive(Discovery, DiscoveryPort, WriterMessage());
    Receive(Discovery, DiscoveryPort, {0});
    EXPECT_EQ(Discovery.Count(), 0u);
}

// The vendor has sent nothing to anybody. The other node sends by another socket than it receives.
TEST_F(SealedUdpTest, ANodeThatIsHeardAndNotKnownIsToldOfThisSession)
{
    Bytes unknown(100);
    Rabit::Envelope::WriteOuter({.Epoch = 1, .Tag = 5, .Number = 1}, unknown);
    Receive(Discovery, DiscoveryPort, unknown);
    EXPECT_GT(Usual().Next().size(), Rabit::Envelope::OuterSize);
}

TEST(SealedUdp, TheVendorLeavesRoomForTheSeal)
{
    Rabit::TransportSettings settings;
    settings.Node = "uav1";
    settings.Interfaces = {"127.0.0.1"};
    settings.Member = Rabit::Conformance::TestMembers().Member("uav1");
    const auto seal = std::make_shared<Rabit::Envelope::SealedSession>(settings.Member);
    const auto attributes =
        MakeParticipantAttributes(settings, std::make_shared<Rabit::SessionLog>(settings), {.Seal = seal});
    ASSERT_EQ(attributes.userTransports.size(), 1u);
    EXPECT_EQ(attributes.userTransports[0]->max_message_size() + seal->MostAdded(), settings.MaxDatagram);
}

}  // namespace
