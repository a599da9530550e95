#include "common/HandshakeFragments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "KeyExchangeMessage.h"
#include "common/KeyExchange.h"
#include "common/KeyExchangeStamp.h"
#include "common/RtpsReader.h"

namespace
{

using Rabit::CutHandshake;
using Rabit::KeyExchange;
using Rabit::KeyExchangeStamp;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t Largest = 1400;

Bytes LargeMessage(std::uint8_t number = 7)
{
    return KeyExchangeMessage().To(1).Handshake("Request", number, 1, 4000).Datagram;
}

TEST(HandshakeFragmentsTest, FragmentsHaveRoomForAStamp)
{
    for (const Bytes &piece : CutHandshake(LargeMessage(), Largest))
    {
        EXPECT_LE(piece.size() + KeyExchangeStamp::Size, Largest);
    }
}

TEST(HandshakeFragmentsTest, TheFirstFragmentTellsTheStepAndAllTheNumber)
{
    const auto pieces = CutHandshake(LargeMessage(), Largest);
    ASSERT_GT(pieces.size(), 2U);
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
        const auto what = Rabit::ReadKeyExchange(pieces[i]);
        ASSERT_TRUE(what);
        EXPECT_EQ(what->What, i == 0 ? KeyExchange::Step::Request : KeyExchange::Step::Rest);
        EXPECT_EQ(what->Number, 7U);
        EXPECT_EQ(what->To, Rabit::ReadKeyExchange(LargeMessage())->To);
    }
}

TEST(HandshakeFragmentsTest, TheFragmentsTogetherAreThePayload)
{
    constexpr std::size_t HeadOfData = 20;
    constexpr std::size_t HeadOfFragment = 32;
    const auto contentOf = [](const Bytes &datagram, std::size_t head)
    {
        Bytes content;
        Rabit::Rtps::VisitSubmessages(std::span(datagram),
                                      [&](const Rabit::Rtps::ConstSubmessage &submessage)
                                      {
                                          if (submessage.Kind == Rabit::Rtps::SubmessageKind::Data ||
                                              submessage.Kind == Rabit::Rtps::SubmessageKind::DataFrag)
                                          {
                                              const auto body = submessage.Body().subspan(head);
                                              content.assign(body.begin(), body.end());
                                          }
                                      });
        return content;
    };
    Bytes joined;
    for (const Bytes &piece : CutHandshake(LargeMessage(), Largest))
    {
        const Bytes part = contentOf(piece, HeadOfFragment);
        joined.insert(joined.end(), part.begin(), part.end());
    }
    EXPECT_EQ(joined, contentOf(LargeMessage(), HeadOfData));
}

TEST(HandshakeFragmentsTest, ASmallMessageStaysWhole)
{
    EXPECT_TRUE(CutHandshake(KeyExchangeMessage().To(1).Handshake("Final", 7, 1).Datagram, Largest).empty());
}

TEST(HandshakeFragmentsTest, OtherDatagramsStayWhole)
{
    EXPECT_TRUE(CutHandshake({}, Largest).empty());
    EXPECT_TRUE(CutHandshake(Bytes(5000, 1), Largest).empty());
    EXPECT_TRUE(CutHandshake(LargeMessage(), 60).empty());
}

}  // namespace
