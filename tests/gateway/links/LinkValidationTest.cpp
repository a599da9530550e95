// A malformed frame is dropped and counted, and changes nothing else.
#include "NodeUnderTest.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <utility>

namespace Rabit::Test
{
namespace
{

constexpr std::uint64_t NoHigherExists = std::numeric_limits<std::uint64_t>::max();

// A node in the midst of traffic: a session from "b", and messages on their way to it.
class MalformedInput : public testing::Test
{
protected:
    MalformedInput()
    {
        a.Hear(b.Hello());
        a.Hear(b.Data(1, {"1", "2"}, a.Now));
        a.Enqueue("1");
        a.Enqueue("2");
        a.Pass(3ms);
        _before = a.Node->Describe();
        a.TakeDelivered();
    }

    template <typename Message>
    void ExpectDropped(const Message &message, const char *what)
    {
        const std::uint64_t counted = a.Node->Counters().Malformed;
        a.Hear(message);
        EXPECT_EQ(a.Node->Counters().Malformed, counted + 1) << what;
        EXPECT_EQ(a.Node->Describe(), _before) << what;
        EXPECT_TRUE(a.TakeDelivered().empty()) << what;
    }

    NodeUnderTest a;
    PlayedPeer b;

private:
    std::string _before;
};

TEST_F(MalformedInput, DataIsDropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredFrame &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredFrame &d) { d.Fields.Version = LinkVersion + 1; }},
        {"no source", [](StoredFrame &d) { d.Source.clear(); }},
        {"source too long", [](StoredFrame &d) { d.Source.assign(256, 'x'); }},
        {"source is the destination", [](StoredFrame &d) { d.Source = d.Destination; }},
        {"queue too long", [](StoredFrame &d) { d.Queue.assign(256, 'x'); }},
        {"no link", [](StoredFrame &d) { d.Fields.Data.Link = 0; }},
        {"no sender life", [](StoredFrame &d) { d.Fields.SenderLife = 0; }},
        {"impossible sender life", [](StoredFrame &d) { d.Fields.SenderLife = NoHigherExists; }},
        {"no receiver life", [](StoredFrame &d) { d.Fields.ReceiverLife = 0; }},
        {"impossible receiver life", [](StoredFrame &d) { d.Fields.ReceiverLife = NoHigherExists; }},
        {"oldest 0", [](StoredFrame &d) { d.Fields.Data.Oldest = 0; }},
        {"first before the oldest",
         [](StoredFrame &d) { d.Fields.Data.Oldest = d.Items[0].Fields.Sequence + 1; }},
        {"beyond the window", [](StoredFrame &d)
         { d.Items[0].Fields.Sequence = d.Items[0].Fields.Through = 1 + LinkWindowParts; }},
        {"numbers overflow",
         [](StoredFrame &d) { d.Items[0].Fields.Sequence = d.Items[0].Fields.Through = NoHigherExists; }},
        {"no clock", [](StoredFrame &d) { d.Fields.Clock = 0; }},
        {"negative echo time", [](StoredFrame &d) { d.Fields.Echo.Time = -1; }},
        {"negative held time", [](StoredFrame &d) { d.Fields.Echo.HeldFor = -1; }},
        {"negative sending time", [](StoredFrame &d) { d.Fields.Time = -1; }},
        {"no items", [](StoredFrame &d) { d.Items.clear(); }},
        {"too many items", [](StoredFrame &d) { d.Items.resize(LinkMaxItems + 1, d.Items[0]); }},
        {"one number twice", [](StoredFrame &d) { d.Items.resize(2, d.Items[0]); }},
        {"unknown flag", [](StoredFrame &d) { d.Items[0].Fields.Flags |= 16; }},
        {"negative time to live", [](StoredFrame &d) { d.Items[0].Fields.TtlLeft = -2; }},
        {"no type and no number",
         [](StoredFrame &d)
         {
             d.Items[0].Type.clear();
             d.Items[0].Fields.TypeNumber = LinkMaxTypes;
         }},
        {"a number too high", [](StoredFrame &d) { d.Items[0].Fields.TypeNumber = LinkMaxTypes + 1; }},
        {"type too long", [](StoredFrame &d) { d.Items[0].Type.assign(256, 'x'); }},
        {"a type in the middle of a message", [](StoredFrame &d) { d.Items[0].Fields.Flags = LinkFlagLast; }},
        {"through another number", [](StoredFrame &d) { d.Items[0].Fields.Through += 1; }},
        {"skip with a payload", [](StoredFrame &d) { d.Items[0].Fields.Flags = LinkFlagSkip; }},
        {"skip backwards", [](StoredFrame &d) { MakeSkip(d.Items[0], 3, 2); }},
        {"skip of more than a window", [](StoredFrame &d) { MakeSkip(d.Items[0], 3, 3 + LinkWindowParts); }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredFrame data = b.Data(3, {"3"}, a.Now);
        spoil(data);
        ExpectDropped(data, what);
    }
}

TEST_F(MalformedInput, AcknowledgementsAreDropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredFrame &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredFrame &k) { k.Fields.Version = 0; }},
        {"no life", [](StoredFrame &k) { k.Fields.SenderLife = 0; }},
        {"no life of ours", [](StoredFrame &k) { k.Fields.ReceiverLife = 0; }},
        {"no link", [](StoredFrame &k) { k.Ack().Link = 0; }},
        {"consumed without a session", [](StoredFrame &k) { k.Ack().Open = false; }},
        {"a number never sent", [](StoredFrame &k) { k.Ack().Cumulative = 2; }},
        {"a number before the stream", [](StoredFrame &k) { k.Ack().Cumulative = NoHigherExists; }},
        {"outcomes from nowhere", [](StoredFrame &k) { k.Ack().Oldest = 0; }},
        {"outcomes of nothing", [](StoredFrame &k) { k.Ack().Oldest = 3; }},
        {"not the outcomes that are missing", [](StoredFrame &k) { k.Ack().Oldest = 2; }},
        {"holds a number never sent", [](StoredFrame &k) { k.Ack().Held[15] = 1; }},
        {"too many", [](StoredFrame &k) { k.Fields.Acks.resize(LinkMaxAcks + 1, k.Ack()); }},
        {"an echo that overflows",
         [](StoredFrame &k) { k.Fields.Echo.HeldFor = std::numeric_limits<std::int64_t>::max(); }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredFrame ack = b.Ack(1);
        spoil(ack);
        ExpectDropped(ack, what);
    }
}

TEST_F(MalformedInput, HellosAreDropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredFrame &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredFrame &h) { h.Fields.Version = 9; }},
        {"no source", [](StoredFrame &h) { h.Source.clear(); }},
        {"no life", [](StoredFrame &h) { h.Fields.SenderLife = 0; }},
        {"impossible life", [](StoredFrame &h) { h.Fields.SenderLife = NoHigherExists; }},
        {"impossible own life", [](StoredFrame &h) { h.Fields.ReceiverLife = NoHigherExists; }},
        {"no clock", [](StoredFrame &h) { h.Fields.Clock = 0; }},
        {"negative time", [](StoredFrame &h) { h.Fields.Time = -1; }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredFrame hello = b.Hello();
        spoil(hello);
        ExpectDropped(hello, what);
    }
}

TEST_F(MalformedInput, WhatIsMeantForAnotherNodeIsDropped)
{
    const std::string before = a.Node->Describe();
    for (StoredFrame frame : {b.Data(3, {"3"}, a.Now), b.Ack(1), b.Hello()})
    {
        frame.Fields.Check = LinkCheck::OfName("c");
        a.Hear(frame);
    }
    EXPECT_EQ(a.Node->Counters().NotForUs, 3U);
    EXPECT_EQ(a.Node->Describe(), before);
}

TEST_F(MalformedInput, AShortFrameWhoseCheckMeansNothingOnlyCallsForAHello)
{
    a.Pass(1s);
    a.TakeHellos();
    StoredFrame data = b.Data(3, {"3"}, a.Now);
    data.Fields.Short = true;
    data.Fields.Check = 1;
    a.Hear(data);
    EXPECT_TRUE(a.TakeDelivered().empty());
    EXPECT_EQ(a.Node->Counters().UnknownShort, 1U);
    a.Pass(0ms);
    EXPECT_EQ(a.TakeHellos().size(), 1U);
}

TEST_F(MalformedInput, AShortFrameIsFilledIn)
{
    a.Pass(3s);
    StoredFrame data = b.Data(3, {"3"}, a.Now - 1s);
    data.Fields.Echo.HeldFor = LinkTime(900ms).count();
    data.Items[0].Fields.TtlLeft = LinkTime(150ms).count();
    data.Fields.Short = true;
    data.Fields.Check = LinkCheck::OfShort("a", b.Life, b.KnownLife, PlayedPeer::Clock, PlayedPeer::ClockOfA);
    const auto low = [](std::int64_t time) { return time / 1000 % (1LL << 32) * 1000; };
    data.Fields.SenderLife = data.Fields.ReceiverLife = 0;
    data.Fields.Clock = data.Fields.Echo.Clock = 0;
    data.Fields.Time = low(data.Fields.Time);
    data.Fields.Echo.Time = low(data.Fields.Echo.Time);
    a.Hear(data);
    EXPECT_EQ(a.TakeDelivered().size(), 1U) << "100 ms on the way, 150 ms left";
}

TEST_F(MalformedInput, AnAcknowledgementOfAnUnknownLinkOnlyTellsOfThePeer)
{
    StoredFrame ack = b.Ack(1);
    ack.Ack().Link = 7;
    a.Hear(ack);
    EXPECT_EQ(a.Node->Counters().NoSuchLink, 1U);
    EXPECT_TRUE(a.TakeOutcomes().empty());
    b.Life += 1;
    ack = b.Ack(1);
    ack.Ack().Link = 7;
    a.Hear(ack);
    EXPECT_EQ(a.Node->Counters().PeerRestarts, 1U);
}

TEST(LinkLimits, QueuesOfAFormerIncarnationMakeRoomForThoseOfThePresentOne)
{
    LinkSettings settings;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    PlayedPeer b;
    a.Hear(b.Data(1, {"1"}, a.Now));
    b.Life += 1;
    a.Pass(1ms);
    StoredFrame otherQueue = b.Data(1, {"2"}, a.Now);
    otherQueue.Queue = "other";
    a.Hear(otherQueue);
    EXPECT_EQ(a.Node->Counters().TooManyLinks, 0U);
    EXPECT_EQ(a.TakeDelivered(),
              (std::vector<DeliveredMessage>{{"b", "q", "T", "1", false}, {"b", "other", "T", "2", false}}));
    a.Pass(10ms);
    EXPECT_FALSE(a.TakeAcks().empty());
    a.Hear(b.Data(2, {"3"}, a.Now));
    EXPECT_EQ(a.Node->Counters().TooManyLinks, 1U) << "the other one is in use";
}

TEST(LinkLimits, AQueueOfAFormerIncarnationWithAMessageThatWaitsStays)
{
    LinkSettings settings;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    PlayedPeer b;
    a.Answer = LocalQueueResult::Full;
    a.Hear(b.Data(1, {"1"}, a.Now));
    b.Life += 1;
    StoredFrame otherQueue = b.Data(1, {"2"}, a.Now);
    otherQueue.Queue = "other";
    a.Hear(otherQueue);
    EXPECT_EQ(a.Node->Counters().TooManyLinks, 1U);
    a.Answer = LocalQueueResult::Ok;
    a.Node->OnRoom("q");
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDelivered(), (std::vector<DeliveredMessage>{{"b", "q", "T", "1", false}}));
}

TEST(LinkLimits, DatagramsOfTooManyPeersAndLinksAreDropped)
{
    LinkSettings settings;
    settings.MaxPeers = 1;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    PlayedPeer b;
    a.Hear(b.Data(1, {"1"}, a.Now));
    StoredFrame otherQueue = b.Data(1, {"1"}, a.Now);
    otherQueue.Queue = "other";
    a.Hear(otherQueue);
    EXPECT_EQ(a.Node->Counters().TooManyLinks, 1U);
    StoredFrame otherPeer = b.Data(1, {"1"}, a.Now);
    otherPeer.Source = "c";
    a.Hear(otherPeer);
    StoredFrame hello = b.Hello();
    hello.Source = "d";
    a.Hear(hello);
    EXPECT_EQ(a.Node->Counters().TooManyPeers, 2U);
}

TEST(LinkLimits, MessagesForTooManyPeersAndLinksAreRefused)
{
    LinkSettings settings;
    settings.MaxPeers = 1;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    EXPECT_NE(a.Enqueue("1"), 0U);
    EXPECT_EQ(a.Node->Enqueue("b", "other", "T", {}, a.Now).Refusal, LinkRefusal::TooManyLinks);
    EXPECT_EQ(a.Node->Enqueue("c", "q", "T", {}, a.Now).Refusal, LinkRefusal::TooManyPeers);
    EXPECT_EQ(a.Node->Counters().RefusedTooMany, 2U);
}

TEST(LinkLimits, SettingsAndOptionsOutOfRangeAreProgrammingErrors)
{
    const auto makeWith = [](const std::function<void(LinkSettings &)> &spoil)
    {
        LinkSettings settings;
        spoil(settings);
        NodeUnderTest node(settings);
    };
    EXPECT_NO_THROW(makeWith([](LinkSettings &) {}));
    EXPECT_THROW(makeWith([](LinkSettings &s) { s.MinResend = 0ms; }), std::invalid_argument);
    EXPECT_THROW(makeWith([](LinkSettings &s) { s.FirstResend = 2s; }), std::invalid_argument);
    EXPECT_THROW(makeWith([](LinkSettings &s) { s.HelloPeriod = 0ms; }), std::invalid_argument);
    NodeUnderTest a;
    EXPECT_THROW(a.Configure({.Capacity = 0}), std::invalid_argument);
    EXPECT_THROW(a.Configure({.Window = 0}), std::invalid_argument);
    EXPECT_THROW(a.Configure({.Window = 257}), std::invalid_argument);
    EXPECT_THROW(a.Configure({.Expire = -1ns}), std::invalid_argument);
}

}  // namespace
}  // namespace Rabit::Test
