// MAVLink datagrams on the loopback address, where each is there as soon as its sender has sent it.
#include "mavlink/UdpChannel.h"

#include <gtest/gtest.h>

#include <boost/asio/buffer.hpp>

#include <memory>
#include <string>
#include <vector>

namespace Swarm
{
namespace
{

namespace asio = boost::asio;
using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

const auto Loopback = asio::ip::address_v4::loopback();

class UdpChannelTest : public testing::Test
{
protected:
    // A program that sends to the channel.
    struct Program
    {
        Program(asio::io_context &context) : Socket(context, {Loopback, 0}) { Socket.non_blocking(true); }
        // Returns the next datagram that the program was sent; empty if there is none.
        Bytes Next()
        {
            Bytes bytes(10);
            boost::system::error_code none;
            bytes.resize(Socket.receive(asio::buffer(bytes), 0, none));
            return bytes;
        }
        asio::ip::udp::socket Socket;
    };

    void Send(Program &program, const Bytes &bytes)
    {
        program.Socket.send_to(asio::buffer(bytes), channel.Local());
    }
    // Returns the next bytes that the channel receives; empty if there are none.
    Bytes Received(ByteChannel::Time now)
    {
        Bytes bytes(10);
        bytes.resize(channel.Receive(bytes, now));
        return bytes;
    }

    // Calls Receive each second of this time, as there is nothing to receive.
    void Listen(std::chrono::seconds from, std::chrono::seconds to)
    {
        for (auto now = from; now <= to; now += 1s)
        {
            EXPECT_EQ(Received(now), Bytes{});
        }
    }

    asio::io_context context;
    UdpChannel channel{{Loopback, 0}};
    Program autopilot{context};
    Program neighbour{context};
};

TEST_F(UdpChannelTest, SendsNothingBeforeSomebodyIsHeard)
{
    EXPECT_FALSE(channel.Send(Bytes{1}));
    EXPECT_EQ(Received(0s), Bytes{});
}

TEST_F(UdpChannelTest, AnswersTheFirstSender)
{
    Send(autopilot, {1, 2, 3});
    EXPECT_EQ(Received(0s), (Bytes{1, 2, 3}));
    EXPECT_TRUE(channel.Send(Bytes{4}));
    EXPECT_EQ(autopilot.Next(), Bytes{4});
}

TEST_F(UdpChannelTest, DropsTheDatagramsOfASecondSender)
{
    Send(autopilot, {1});
    Send(neighbour, {2});
    Send(autopilot, {3});
    EXPECT_EQ(Received(0s), Bytes{1});
    EXPECT_EQ(Received(0s), Bytes{3});
    EXPECT_EQ(Received(0s), Bytes{});
    EXPECT_EQ(channel.Dropped(), 1U);
}

TEST_F(UdpChannelTest, DoesNotAnswerASecondSender)
{
    Send(autopilot, {1});
    Received(0s);
    Send(neighbour, {2});
    Received(0s);
    EXPECT_TRUE(channel.Send(Bytes{3}));
    EXPECT_EQ(neighbour.Next(), Bytes{});
    EXPECT_EQ(autopilot.Next(), Bytes{3});
}

TEST_F(UdpChannelTest, KeepsAnAutopilotThatIsSilentForAMoment)
{
    Send(autopilot, {1});
    Received(0s);
    Listen(1s, UdpChannel::PeerSilentAfter - 1s);
    Send(neighbour, {2});
    EXPECT_EQ(Received(UdpChannel::PeerSilentAfter), Bytes{});
}

TEST_F(UdpChannelTest, TakesAnotherSenderOnceTheAutopilotIsSilent)
{
    Send(autopilot, {1});
    Received(0s);
    Listen(1s, UdpChannel::PeerSilentAfter);
    Send(neighbour, {2});
    EXPECT_EQ(Received(UdpChannel::PeerSilentAfter + 1ms), Bytes{2});
    EXPECT_TRUE(channel.Send(Bytes{3}));
    EXPECT_EQ(neighbour.Next(), Bytes{3});
}

TEST_F(UdpChannelTest, ASilenceIsCountedFromTheLastDatagram)
{
    Send(autopilot, {1});
    Received(0s);
    Listen(1s, 3s);
    Send(autopilot, {2});
    Received(4s);
    Listen(5s, 7s);
    Send(neighbour, {3});
    EXPECT_EQ(Received(8s), Bytes{});
}

TEST_F(UdpChannelTest, AStandstillOfThisProgramIsNoSilenceOfTheAutopilot)
{
    Send(autopilot, {1});
    Received(0s);
    Send(neighbour, {2});
    Send(autopilot, {3});
    EXPECT_EQ(Received(20s), Bytes{3});
}

TEST_F(UdpChannelTest, ThereIsALimitOfWhatIsDroppedAtOneMoment)
{
    Send(autopilot, {1});
    EXPECT_EQ(Received(0s), Bytes{1});
    for (std::uint8_t round = 2; round < 4; ++round)
    {
        for (int i = 0; i < 150; ++i)
        {
            Send(neighbour, {0});
        }
        Send(autopilot, {round});
        EXPECT_EQ(Received(0s), round == 2 ? Bytes{2} : Bytes{});
    }
    EXPECT_EQ(Received(20ms), Bytes{3});
}

// Returns a port that was free a moment ago.
unsigned FreePort(asio::io_context &context)
{
    return asio::ip::udp::socket(context, {asio::ip::address_v4::any(), 0}).local_endpoint().port();
}

TEST(UdpDescription, APortAloneIsOneOfTheLoopbackAddress)
{
    asio::io_context context;
    const auto channel = OpenByteChannel("udp:" + std::to_string(FreePort(context)));
    ASSERT_NE(dynamic_cast<UdpChannel *>(channel.get()), nullptr);
    EXPECT_EQ(dynamic_cast<UdpChannel &>(*channel).Local().address(), Loopback);
}

TEST(UdpDescription, AnAddressIsTheOneThatIsListenedOn)
{
    asio::io_context context;
    const auto channel = OpenByteChannel("udp:127.0.0.2:" + std::to_string(FreePort(context)));
    ASSERT_NE(dynamic_cast<UdpChannel *>(channel.get()), nullptr);
    EXPECT_EQ(dynamic_cast<UdpChannel &>(*channel).Local().address(), asio::ip::make_address("127.0.0.2"));
}

}  // namespace
}  // namespace Swarm
