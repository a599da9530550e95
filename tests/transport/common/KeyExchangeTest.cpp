// `ReadKeyExchange` on the datagrams with which two participants exchange keys.
#include "common/KeyExchange.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "KeyExchangeMessage.h"

namespace
{

using Rabit::KeyExchange;
using Rabit::ReadKeyExchange;
using Message = KeyExchangeMessage;
using Step = KeyExchange::Step;

std::optional<KeyExchange> Read(const Message &message)
{
    return ReadKeyExchange(message.Datagram);
}

KeyExchange::Prefix Prefix(std::uint8_t participant)
{
    KeyExchange::Prefix prefix;
    prefix.fill(participant);
    return prefix;
}

TEST(KeyExchangeTest, StepsOfAHandshakeAreTold)
{
    EXPECT_EQ(Read(Message().To(7).Handshake("AuthReq", 1, 7))->What, Step::Ask);
    EXPECT_EQ(Read(Message().To(7).Handshake("Req", 1, 7))->What, Step::Request);
    EXPECT_EQ(Read(Message().To(7).Handshake("Reply", 1, 7))->What, Step::Reply);
    EXPECT_EQ(Read(Message().To(7).Handshake("Final", 1, 7))->What, Step::Final);
}

TEST(KeyExchangeTest, WhoSaysItToWhomAndItsNumberAreTold)
{
    const auto found = Read(Message().To(7).Handshake("Req", 9, 7));
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->From, Prefix(Message::Self));
    EXPECT_EQ(found->To, Prefix(7));
    EXPECT_EQ(found->Number, 9U);
}

TEST(KeyExchangeTest, AMessageOfAHandshakeToAnotherThanItsAddresseeIsTold)
{
    EXPECT_FALSE(Read(Message().To(7).Handshake("Req", 1, 7))->IsForOther);
    EXPECT_TRUE(Read(Message().To(7).Handshake("Req", 1, 8))->IsForOther);
}

TEST(KeyExchangeTest, TheFirstFragmentTellsTheStepAndLaterOnesTheNumberAlone)
{
    EXPECT_EQ(Read(Message().To(7).Fragment("Reply", 3, 7, 1))->What, Step::Reply);
    const auto later = Read(Message().To(7).Fragment("Reply", 3, 7, 2));
    ASSERT_TRUE(later.has_value());
    EXPECT_EQ(later->What, Step::Rest);
    EXPECT_EQ(later->Number, 3U);
    EXPECT_FALSE(later->IsForOther);
}

TEST(KeyExchangeTest, WithInlineQosNoAddresseeIsRead)
{
    Message message;
    message.To(7).Handshake("Req", 1, 8);
    message.Datagram[20 + 16 + 1] |= 0x02;
    ASSERT_TRUE(Read(message).has_value());
    EXPECT_FALSE(Read(message)->IsForOther);
}

TEST(KeyExchangeTest, KeysAreToldFromTheirControlBySize)
{
    EXPECT_EQ(Read(Message().To(7).Encrypted(0, 1, 200))->What, Step::Keys);
    EXPECT_EQ(Read(Message().To(7).Encrypted(0, 1, 36))->What, Step::Control);
    EXPECT_FALSE(Read(Message().To(7).Encrypted(0, 1, 200))->IsWhole);
}

TEST(KeyExchangeTest, SessionsOfKeysAreToldApart)
{
    EXPECT_NE(Read(Message().To(7).Encrypted(0, 1, 36))->Source,
              Read(Message().To(7).Encrypted(0, 2, 36))->Source);
}

TEST(KeyExchangeTest, WhatIsProtectedAsAWholeIsTold)
{
    const auto control = Read(Message().Signed().To(7).Acknowledge(3));
    ASSERT_TRUE(control.has_value());
    EXPECT_TRUE(control->IsWhole);
    EXPECT_EQ(control->What, Step::Control);
    EXPECT_EQ(Read(Message().Signed().To(7).Encrypted(5, 1, 200))->What, Step::Keys);
}

TEST(KeyExchangeTest, EndpointsThatHaveAProtectedCounterpartAreIdle)
{
    for (const std::uint8_t writer : Message::Bytes{3, 4})
    {
        EXPECT_TRUE(Read(Message().To(7).Acknowledge(writer))->IsIdle);
        EXPECT_TRUE(Read(Message().Signed().To(7).Acknowledge(writer))->IsIdle);
    }
    EXPECT_FALSE(Read(Message().Signed().To(7).Acknowledge(1))->IsIdle)
        << "participants are announced in plain";
}

TEST(KeyExchangeTest, ADatagramThatHasAnythingElseIsNotIdle)
{
    EXPECT_FALSE(Read(Message().To(7).Acknowledge(3).Encrypted(0, 1, 36))->IsIdle);
    EXPECT_FALSE(Read(Message().Signed().To(7).Acknowledge(3).Acknowledge(1))->IsIdle);
}

TEST(KeyExchangeTest, OthersAreNone)
{
    EXPECT_FALSE(Read(Message()).has_value());
    EXPECT_FALSE(Read(Message().To(7).Acknowledge(1)).has_value());
    EXPECT_FALSE(Read(Message().To(7).Encrypted(5, 1, 200)).has_value());
    EXPECT_FALSE(ReadKeyExchange({}).has_value());
}

TEST(KeyExchangeTest, WhateverIsCutOffOrAlteredIsReadWithinItsBounds)
{
    Message message;
    message.To(7)
        .Fragment("Req", 1, 7, 1)
        .Handshake("Reply", 2, 7)
        .Encrypted(0, 1, 80)
        .Signed()
        .Acknowledge(3);
    for (std::size_t size = 0; size <= message.Datagram.size(); ++size)
    {
        // A copy of this size, so that AddressSanitizer sees a read beyond it.
        Message::Bytes cut(message.Datagram.begin(),
                           message.Datagram.begin() + static_cast<std::ptrdiff_t>(size));
        ReadKeyExchange(cut);
        for (std::size_t at = 0; at < std::min<std::size_t>(size, 60); ++at)
        {
            const std::uint8_t before = cut[at];
            for (const std::uint8_t value : Message::Bytes{0x00, 0x7f, 0xff})
            {
                cut[at] = value;
                ReadKeyExchange(cut);
            }
            cut[at] = before;
        }
    }
}

}  // namespace
