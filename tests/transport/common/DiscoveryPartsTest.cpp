// Of what a datagram of discovery consists, and which parts say the same.
#include "common/DiscoveryParts.h"

#include <gtest/gtest.h>

#include "DiscoveryMessage.h"

namespace
{

using Rabit::DiscoveryPart;
using Rabit::ReadDiscoveryParts;
using Message = DiscoveryMessage;

DiscoveryPart OnlyPartOf(const Message &message)
{
    const auto parts = ReadDiscoveryParts(message.Datagram);
    EXPECT_TRUE(parts && parts->size() == 1);
    return parts && !parts->empty() ? parts->front() : DiscoveryPart{};
}

TEST(DiscoveryParts, TheCountAloneMakesNothingNew)
{
    EXPECT_EQ(OnlyPartOf(Message().To(1).Acknowledge(5, 1)).Content,
              OnlyPartOf(Message().To(1).Acknowledge(5, 2)).Content);
    EXPECT_EQ(OnlyPartOf(Message().To(1).Beat(5, 1)).Content, OnlyPartOf(Message().To(1).Beat(5, 2)).Content);
}

TEST(DiscoveryParts, NumbersMakeSomethingNewOfTheSameSubject)
{
    const auto first = OnlyPartOf(Message().To(1).Acknowledge(5, 1));
    const auto second = OnlyPartOf(Message().To(1).Acknowledge(6, 1));
    EXPECT_NE(first.Content, second.Content);
    EXPECT_EQ(first.About, second.About);
    EXPECT_NE(OnlyPartOf(Message().To(1).Beat(5, 1)).Content, OnlyPartOf(Message().To(1).Beat(6, 1)).Content);
}

TEST(DiscoveryParts, PeersKindsWritersAndNumbersOfNewsAreSubjects)
{
    const auto about = OnlyPartOf(Message().To(1).Beat(5, 1)).About;
    EXPECT_NE(OnlyPartOf(Message().To(2).Beat(5, 1)).About, about);
    EXPECT_NE(OnlyPartOf(Message().Beat(5, 1)).About, about);
    EXPECT_NE(OnlyPartOf(Message().To(1).Beat(5, 1, 0x03)).About, about);
    EXPECT_NE(OnlyPartOf(Message().To(1).Acknowledge(5, 1)).About, about);
    EXPECT_NE(OnlyPartOf(Message().News(1)).About, OnlyPartOf(Message().News(2)).About);
}

TEST(DiscoveryParts, WhatElseIsSaidMakesTheWholeDatagramAnother)
{
    EXPECT_FALSE(ReadDiscoveryParts(Message().Say(Message::ParticipantWriter, 1).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message().News(1).Say(Message::ParticipantWriter, 1).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message().To(1).Acknowledge(5, 1, 0x03).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message().To(1).Beat(5, 1).Acknowledge(5, 1, 0x03).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message().To(1).Beat(5, 1).Add(0x08, Message::Bytes(28)).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message().To(1).Datagram));
    EXPECT_FALSE(ReadDiscoveryParts(Message::Bytes()));
}

TEST(DiscoveryParts, EachPartCanStandAlone)
{
    const auto parts = ReadDiscoveryParts(Message().At(3).To(1).News(1).Beat(5, 1).To(2).Beat(5, 1).Datagram);
    ASSERT_TRUE(parts.has_value());
    ASSERT_EQ(parts->size(), 3u);
    EXPECT_EQ(parts->at(0).About.To, DiscoveryPart::Prefix({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(parts->at(1).About.To, parts->at(0).About.To);
    EXPECT_NE(parts->at(2).About.To, parts->at(0).About.To);
    const auto after = [](const Message &message)
    { return Message::Bytes(message.Datagram.begin() + 20, message.Datagram.end()); };
    EXPECT_EQ(parts->at(0).Bytes, after(Message().At(3).News(1)));
    EXPECT_EQ(parts->at(1).Bytes, after(Message().Beat(5, 1)));
}

TEST(DiscoveryParts, ALengthThatMeansToTheEndIsSaidSoThatOthersCanFollow)
{
    auto message = Message().News(1).Datagram;
    const auto whole = message;
    message[20 + 2] = 0;
    EXPECT_EQ(OnlyPartOf({.Datagram = message}).Bytes, Message::Bytes(whole.begin() + 20, whole.end()));
    message.push_back(0);  // nothing can follow that
    EXPECT_FALSE(ReadDiscoveryParts(message));
}

TEST(DiscoveryParts, NewsForAllAreTheSameWhateverReaderTheyWereFor)
{
    const auto news = OnlyPartOf(Message().At(3).News(1));
    const auto made = ForAll(OnlyPartOf(Message().At(3).To(1).News(1, 4)));
    EXPECT_EQ(made.About, news.About);
    EXPECT_EQ(made.Content, news.Content);
    EXPECT_EQ(made.Bytes, news.Bytes);
}

TEST(DiscoveryParts, WhatIsCutOffIsReadWithoutHarm)
{
    const auto whole = Message().At(3).To(1).Beat(5, 1).Acknowledge(5, 1).News(1).Datagram;
    for (std::size_t size = 0; size <= whole.size(); ++size)
    {
        const Message::Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        ReadDiscoveryParts(cut);
    }
    EXPECT_TRUE(ReadDiscoveryParts(whole));
}

}  // namespace
