// The datagrams of a turn.
#include "common/SendingTurn.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "envelope/MergedDatagram.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::SendingTurn;
using Rabit::Rtps::MergedDatagram;

const SendingTurn::Way Here{1, 2};
const SendingTurn::Way There{1, 3};

Bytes Numbered(std::int64_t number)
{
    return Message(Data, DataBody(number), 5);
}

Bytes BodyOf(std::int64_t number)
{
    return Submessage(Data, DataBody(number), 5);
}

class SendingTurnTest : public testing::Test
{
protected:
    SendingTurn::Grown Take(const SendingTurn::Way &way, const Bytes &datagram)
    {
        return Turn.Take(way, datagram,
                         [&](std::size_t most)
                         {
                             return std::make_unique<MergedDatagram>(
                                 most, [this, way](Bytes &message) { Sent.emplace_back(way, message); });
                         });
    }

    std::vector<std::pair<SendingTurn::Way, Bytes>> Sent;
    SendingTurn Turn;
};

TEST_F(SendingTurnTest, TheDatagramsThatGoOneWayGoAsOneAtTheEnd)
{
    ASSERT_TRUE(Turn.Begin(1000));
    const auto first = Take(Here, Numbered(1));
    EXPECT_EQ(first.Datagrams, 1u);
    EXPECT_EQ(first.Bytes, Numbered(1).size());
    const auto second = Take(Here, Numbered(2));
    EXPECT_EQ(second.Datagrams, 0u);
    EXPECT_EQ(second.Bytes, BodyOf(2).size());
    EXPECT_TRUE(Sent.empty());
    Turn.End();
    ASSERT_EQ(Sent.size(), 1u);
    EXPECT_EQ(Sent[0].second, Join({Numbered(1), BodyOf(2)}));
}

TEST_F(SendingTurnTest, DatagramsThatGoElsewhereStayApart)
{
    ASSERT_TRUE(Turn.Begin(1000));
    Take(Here, Numbered(1));
    Take(There, Numbered(2));
    Take(Here, Numbered(3));
    Turn.End();
    ASSERT_EQ(Sent.size(), 2u);
    EXPECT_EQ(Sent[0], std::pair(Here, Join({Numbered(1), BodyOf(3)})));
    EXPECT_EQ(Sent[1], std::pair(There, Numbered(2)));
}

// A small one does not pass a large one.
TEST_F(SendingTurnTest, DatagramsThatGoOneWayKeepTheirOrder)
{
    const Bytes large = Message(Data, DataBody(2, Bytes(400)), 5);
    ASSERT_TRUE(Turn.Begin(200));
    Take(Here, Numbered(1));
    EXPECT_EQ(Take(Here, large).Datagrams, 1u);
    EXPECT_EQ(Take(Here, Numbered(3)).Datagrams, 1u);
    Turn.End();
    ASSERT_EQ(Sent.size(), 3u);
    EXPECT_EQ(Sent[0].second, Numbered(1));
    EXPECT_EQ(Sent[1].second, large);
    EXPECT_EQ(Sent[2].second, Numbered(3));
}

TEST_F(SendingTurnTest, ItIsOfTheThreadThatBeganItUntilItEnds)
{
    EXPECT_FALSE(Turn.IsOfThisThread());
    ASSERT_TRUE(Turn.Begin(1000));
    EXPECT_TRUE(Turn.IsOfThisThread());
    bool isOfOther = true;
    std::thread([&] { isOfOther = Turn.IsOfThisThread(); }).join();
    EXPECT_FALSE(isOfOther);
    SendingTurn other;
    EXPECT_FALSE(other.Begin(1000)) << "in the turn of another session";
    EXPECT_FALSE(other.IsOfThisThread());
    Turn.End();
    EXPECT_FALSE(Turn.IsOfThisThread());
    EXPECT_TRUE(other.Begin(1000));
    other.Drop();
}

TEST_F(SendingTurnTest, WhatIsDroppedIsNeverSent)
{
    ASSERT_TRUE(Turn.Begin(1000));
    Take(Here, Numbered(1));
    Turn.Drop();
    ASSERT_TRUE(Turn.Begin(1000));
    Turn.End();
    EXPECT_TRUE(Sent.empty());
}

TEST_F(SendingTurnTest, EqualSetsOfDestinationsHaveOneNumber)
{
    ASSERT_TRUE(Turn.Begin(1000));
    EXPECT_EQ(Turn.TakeDestinations().Count, 0u);
    Take(Here, Numbered(1));
    const auto here = Turn.TakeDestinations();
    EXPECT_EQ(here.Count, 1u);
    EXPECT_NE(here.Number, 0u);
    Take(There, Numbered(1));
    EXPECT_NE(Turn.TakeDestinations().Number, here.Number);
    Take(Here, Numbered(2));
    EXPECT_EQ(Turn.TakeDestinations().Number, here.Number);
    Take(Here, Numbered(3));
    Take(There, Numbered(3));
    const auto both = Turn.TakeDestinations();
    Take(There, Numbered(4));
    Take(Here, Numbered(4));
    const auto turned = Turn.TakeDestinations();
    EXPECT_EQ(both.Count, 2u);
    EXPECT_EQ(both.Number, turned.Number);
    EXPECT_NE(both.Number, here.Number);
    Turn.Drop();
}

}  // namespace
