// The guard lets through announcements and handshakes that agree with each other, and a thread looks at the
// participants that are not authenticated.
#include "guard/AuthenticationThread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <thread>

#include "guard/Gate.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::KeyExchange;
using Rabit::Rtps::AuthenticationThread;
using Rabit::Rtps::RtpsGuard;

constexpr EntityId HandshakeWriter = 0x000201c3;

Bytes BigEndian32(std::uint32_t value)
{
    return {static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
            static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
}

Bytes SignedLease(std::uint32_t seconds)
{
    return Join({{0, 0x02, 0, 8}, BigEndian32(seconds), BigEndian32(0)});
}

Bytes SignedAddress(std::uint8_t use, std::uint32_t port)
{
    return Join({{0, use, 0, 24}, BigEndian32(1), BigEndian32(port), Bytes(12), {127, 0, 0, 1}});
}

// A message of a handshake whose `c.pdata` holds these parameters.
Bytes HandshakeMessage(std::initializer_list<Bytes> parameters)
{
    const Bytes data = Join({Join(parameters), {0, 1, 0, 0}});
    const Bytes token = Join({Text("DDS:Auth:PKI-DH:1.0+Req"), U32(0), U32(1), Text("c.pdata"),
                              U32(static_cast<std::uint32_t>(data.size())), data});
    return Message(
        Data,
        DataBody(1, Join({{0, 1, 0, 0}, Bytes(96), Text("dds.sec.auth"), U32(1), token}), HandshakeWriter),
        5);
}

class AuthenticationTest : public testing::Test
{
protected:
    AuthenticationTest() { Guard.SetAuthentication(Thread); }
    // True if the vendor gets the datagram; it is counted if not.
    bool Passes(Bytes datagram)
    {
        bool passed = false;
        const bool honest =
            Guard.Admit(datagram, SenderHost, Rabit::Rtps::KnownPeers::TimePoint(std::chrono::hours(1)),
                        [&](std::span<std::uint8_t>) { passed = true; });
        EXPECT_EQ(passed, honest);
        return passed;
    }

    AuthenticationThread Thread;
    RtpsGuard Guard{RtpsGuard::Mode::Protected, std::chrono::seconds(10)};
};

TEST_F(AuthenticationTest, TheVendorSeesOneContentOfAParticipantUntilItIsGone)
{
    EXPECT_TRUE(Passes(ParticipantMessage(Sender, 7410)));
    EXPECT_FALSE(Passes(ParticipantMessage(Sender, 7411)));
    EXPECT_TRUE(Passes(ParticipantMessage(Sender, 7410)));
    EXPECT_TRUE(Passes(ParticipantMessage(Other, 7411)));
    Thread.Gone(Sender);
    EXPECT_TRUE(Passes(ParticipantMessage(Sender, 7411)));
}

TEST_F(AuthenticationTest, TheVendorSeesNoHandshakeThatSignsAnythingElseThanWasAnnounced)
{
    constexpr std::uint8_t unicast = 0x32;
    constexpr std::uint8_t multicast = 0x33;
    EXPECT_TRUE(Passes(ParticipantMessage(Sender, 7410)));
    EXPECT_TRUE(Passes(HandshakeMessage({SignedLease(3), SignedAddress(unicast, 7410)})));
    EXPECT_TRUE(Passes(HandshakeMessage({SignedAddress(unicast, 7410), SignedLease(3)})));
    EXPECT_FALSE(Passes(HandshakeMessage({SignedLease(3), SignedAddress(unicast, 7411)})));
    EXPECT_FALSE(Passes(HandshakeMessage({SignedLease(4), SignedAddress(unicast, 7410)})));
    EXPECT_FALSE(Passes(HandshakeMessage({SignedLease(3)})));
    EXPECT_FALSE(Passes(
        HandshakeMessage({SignedLease(3), SignedAddress(unicast, 7410), SignedAddress(unicast, 7412)})));
    EXPECT_FALSE(Passes(
        HandshakeMessage({SignedLease(3), SignedAddress(unicast, 7410), SignedAddress(multicast, 7400)})));
}

// A thread whose attempts are short, and a participant that announces itself.
class AuthenticationCallsTest : public testing::Test
{
protected:
    AuthenticationCallsTest()
    {
        Thread.Start({.IsAuthenticated = [this](const auto &) { return Authenticated.load(); },
                      .Ask = [this](const auto &peer) { Asked = peer == Sender; },
                      .IsWaiting = [this](const auto &) { return ++Looks < WaitingLooks; },
                      .AnswerTime = [] { return AuthenticationThread::Clock::duration(0); },
                      .Forget =
                          [this](const auto &peer, auto number)
                      {
                          Thread.Gone(peer);
                          ForgottenWith = peer == Sender ? number : -1;
                      },
                      .Drop = [this](const auto &peer) { Dropped = peer == Sender; }});
    }
    ~AuthenticationCallsTest() override { Thread.Stop(); }
    template <typename Condition>
    void AnnounceUntil(const Condition &holds)
    {
        while (!holds())
        {
            Thread.Announced(Sender, {.Number = LastNumber});
            std::this_thread::yield();
        }
    }
    bool IsForgotten() const { return ForgottenWith != 0; }

    static constexpr std::int64_t LastNumber = 7;
    std::atomic<bool> Authenticated{false};
    std::atomic<bool> Asked{false};
    std::atomic<bool> Dropped{false};
    std::atomic<std::int64_t> ForgottenWith{0};
    std::atomic<int> Looks{0};
    std::atomic<int> WaitingLooks{0};
    AuthenticationThread Thread{false, std::chrono::milliseconds(1)};
};

TEST_F(AuthenticationCallsTest, AParticipantThatIsNotAuthenticatedIsForgotten)
{
    AnnounceUntil([this] { return IsForgotten(); });
    EXPECT_EQ(ForgottenWith, LastNumber + 1);
    EXPECT_TRUE(Dropped);
}

TEST_F(AuthenticationCallsTest, AParticipantWhoseMessageWaitsIsNotForgottenYet)
{
    WaitingLooks = 3;
    AnnounceUntil([this] { return IsForgotten(); });
    EXPECT_GE(Looks, 3);
}

TEST_F(AuthenticationCallsTest, AnAuthenticatedParticipantThatBeginsAnewAndDoesNotAnswerIsForgotten)
{
    Authenticated = true;
    AnnounceUntil(
        [this]
        {
            Thread.SaidGoodbye(Sender);
            return Asked.load();
        });
    EXPECT_FALSE(IsForgotten());
    Authenticated = false;
    AnnounceUntil([this] { return IsForgotten(); });
}

TEST(AuthenticationThreadTest, AStoppedThreadMakesNoCall)
{
    AuthenticationThread thread;
    thread.Start({.IsAuthenticated = [](const auto &) { return false; },
                  .Ask = [](const auto &) { ADD_FAILURE(); },
                  .IsWaiting = [](const auto &) { return false; },
                  .AnswerTime = [] { return AuthenticationThread::Clock::duration(0); },
                  .Forget = [](const auto &, auto) { ADD_FAILURE(); },
                  .Drop = [](const auto &) { ADD_FAILURE(); }});
    thread.Announced(Sender, {});
    thread.Stop();
    thread.Announced(Sender, {});
    thread.Gone(Sender);
    EXPECT_FALSE(thread.WasForgotten(Sender));
}

}  // namespace
