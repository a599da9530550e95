#include "HandshakeEnds.h"

#include <gtest/gtest.h>

#include <string>

namespace
{

using Rabit::Cyclone::HandshakeEnds;

constexpr RabitCycloneRoute Route{nullptr, {10, 0, 0, 1}, 7410};
constexpr HandshakeEnds::TimePoint Start{std::chrono::seconds(100)};
constexpr auto Later = Start + std::chrono::seconds(1);

// A message from `from` to `to`. Each GUID prefix is twelve times the byte given.
std::vector<std::uint8_t> Message(std::uint8_t from, std::uint8_t to, const std::string &text)
{
    std::vector<std::uint8_t> bytes{'R', 'T', 'P', 'S', 2, 1, 1, 16};
    bytes.insert(bytes.end(), 12, from);
    bytes.insert(bytes.end(), {0x0e, 0x01, 12, 0});
    bytes.insert(bytes.end(), 12, to);
    bytes.insert(bytes.end(), {0x15, 0x05, 0, 0});
    bytes.insert(bytes.end(), text.begin(), text.end());
    return bytes;
}
std::vector<std::uint8_t> Final(std::uint8_t to)
{
    return Message(1, to, "DDS:Auth:PKI-DH:1.0+Final");
}
std::vector<std::uint8_t> Reply(std::uint8_t from)
{
    return Message(from, 1, "DDS:Auth:PKI-DH:1.0+Reply");
}

TEST(HandshakeEnds, WhoShowsItsCertificateAgainIsAnsweredAgainAWhileLater)
{
    HandshakeEnds ends;
    ends.Sent(Final(2), Route);
    ends.Received(Reply(2), Start);
    EXPECT_TRUE(ends.TakeDue(Start + HandshakeEnds::Delay / 2).empty());
    const auto again = ends.TakeDue(Later);
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(again[0].Bytes, Final(2));
    EXPECT_EQ(again[0].Route.port, Route.port);
}

TEST(HandshakeEnds, ItIsAnsweredOnce)
{
    HandshakeEnds ends;
    ends.Sent(Final(2), Route);
    ends.Received(Reply(2), Start);
    EXPECT_EQ(ends.TakeDue(Later).size(), 1U);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
}

TEST(HandshakeEnds, WhileItIsShownItIsNotAnswered)
{
    HandshakeEnds ends;
    ends.Sent(Final(2), Route);
    ends.Received(Reply(2), Start);
    ends.Received(Reply(2), Later);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
    EXPECT_EQ(ends.TakeDue(Later + HandshakeEnds::Delay).size(), 1U);
}

TEST(HandshakeEnds, WhoHasNotBeenAnsweredYetIsNot)
{
    HandshakeEnds ends;
    ends.Sent(Final(2), Route);
    ends.Received(Reply(3), Start);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
}

TEST(HandshakeEnds, TheLastOfAHandshakeThatBeganAnewCounts)
{
    HandshakeEnds ends;
    ends.Sent(Message(1, 2, "DDS:Auth:PKI-DH:1.0+Final older"), Route);
    ends.Sent(Final(2), Route);
    ends.Received(Reply(2), Start);
    EXPECT_EQ(ends.TakeDue(Later).at(0).Bytes, Final(2));
}

TEST(HandshakeEnds, OtherMessagesAreNone)
{
    HandshakeEnds ends;
    ends.Sent(Message(1, 2, "DDS:Auth:PKI-DH:1.0+Req"), Route);
    ends.Received(Reply(2), Start);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
    ends.Sent(Final(2), Route);
    ends.Received(Message(2, 1, "DDS:Auth:PKI-DH:1.0+Req"), Start);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
}

TEST(HandshakeEnds, TruncatedOnesDoNoHarm)
{
    HandshakeEnds ends;
    const auto sent = Final(2);
    const auto came = Reply(2);
    for (std::size_t size = 0; size <= sent.size(); ++size)
    {
        ends.Sent(std::span(sent).first(size), Route);
        ends.Received(std::span(came).first(size), Start);
    }
    EXPECT_EQ(ends.TakeDue(Later).size(), 1U);
}

TEST(HandshakeEnds, OfManyTheLastAreRemembered)
{
    HandshakeEnds ends;
    for (std::size_t i = 0; i <= HandshakeEnds::MostPeers; ++i)
    {
        auto message = Final(0);
        message[24] = static_cast<std::uint8_t>(i >> 8);
        message[25] = static_cast<std::uint8_t>(i);
        ends.Sent(message, Route);
    }
    ends.Received(Reply(0), Start);
    EXPECT_TRUE(ends.TakeDue(Later).empty());
}

}  // namespace
