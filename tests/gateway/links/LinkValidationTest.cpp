// What is malformed is dropped and counted, and changes nothing else.
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

// A node in the middle of everything: a session from "b", and messages on their way to it.
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

TEST_F(MalformedInput, data_is_dropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredData &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredData &d) { d.Fields.Version = LinkVersion + 1; }},
        {"no source", [](StoredData &d) { d.Source.clear(); }},
        {"source too long", [](StoredData &d) { d.Source.assign(256, 'x'); }},
        {"source is the destination", [](StoredData &d) { d.Source = d.Destination; }},
        {"no queue", [](StoredData &d) { d.Queue.clear(); }},
        {"no sender life", [](StoredData &d) { d.Fields.SenderIncarnation = 0; }},
        {"impossible sender life", [](StoredData &d) { d.Fields.SenderIncarnation = NoHigherExists; }},
        {"no receiver life", [](StoredData &d) { d.Fields.ReceiverIncarnation = 0; }},
        {"impossible receiver life", [](StoredData &d) { d.Fields.ReceiverIncarnation = NoHigherExists; }},
        {"base 0", [](StoredData &d) { d.Fields.Base = 0; }},
        {"first before base", [](StoredData &d) { d.Fields.Base = d.Fields.First + 1; }},
        {"numbers overflow", [](StoredData &d) { d.Fields.First = NoHigherExists; }},
        {"no clock", [](StoredData &d) { d.Fields.Echo.Clock = 0; }},
        {"negative echo time", [](StoredData &d) { d.Fields.Echo.Time = -1; }},
        {"negative held time", [](StoredData &d) { d.Fields.Echo.HeldFor = -1; }},
        {"negative sending time", [](StoredData &d) { d.Fields.SentAt = -1; }},
        {"no items", [](StoredData &d) { d.Items.clear(); }},
        {"too many items", [](StoredData &d) { d.Items.resize(LinkMaxItems + 1, d.Items[0]); }},
        {"unknown flag", [](StoredData &d) { d.Items[0].Flags = 4; }},
        {"negative time to live", [](StoredData &d) { d.Items[0].TtlLeft = -2; }},
        {"no type", [](StoredData &d) { d.Items[0].Type.clear(); }},
        {"type too long", [](StoredData &d) { d.Items[0].Type.assign(256, 'x'); }},
        {"skip with a payload", [](StoredData &d) { d.Items[0].Flags = LinkFlagSkip; }},
        {"the last item",
         [](StoredData &d) {
             d.Items.push_back({8, LinkNoExpiry, "T", {}});
         }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredData data = b.Data(3, {"3"}, a.Now);
        spoil(data);
        ExpectDropped(data, what);
    }
}

TEST_F(MalformedInput, acknowledgements_are_dropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredAck &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredAck &k) { k.Fields.Version = 0; }},
        {"no destination", [](StoredAck &k) { k.Destination.clear(); }},
        {"no queue", [](StoredAck &k) { k.Queue.clear(); }},
        {"no receiver life", [](StoredAck &k) { k.Fields.ReceiverIncarnation = 0; }},
        {"impossible receiver life", [](StoredAck &k) { k.Fields.ReceiverIncarnation = NoHigherExists; }},
        {"impossible sender life", [](StoredAck &k) { k.Fields.SenderIncarnation = NoHigherExists; }},
        {"impossible own life", [](StoredAck &k) { k.Fields.YourIncarnation = NoHigherExists; }},
        {"consumed without a session", [](StoredAck &k) { k.Fields.SenderIncarnation = 0; }},
        {"a number never sent", [](StoredAck &k) { k.Fields.Cumulative = 2; }},
        {"no clock", [](StoredAck &k) { k.Fields.Clock = 0; }},
        {"negative time", [](StoredAck &k) { k.Fields.Time = -1; }},
        {"negative echo", [](StoredAck &k) { k.Fields.EchoSentAt = -1; }},
        {"negative held time", [](StoredAck &k) { k.Fields.EchoHeldFor = -1; }},
        {"an echo that overflows",
         [](StoredAck &k) { k.Fields.EchoHeldFor = std::numeric_limits<std::int64_t>::max(); }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredAck ack = b.Ack(1);
        spoil(ack);
        ExpectDropped(ack, what);
    }
}

TEST_F(MalformedInput, hellos_are_dropped)
{
    using Spoil = std::pair<const char *, std::function<void(StoredHello &)>>;
    const std::vector<Spoil> spoils = {
        {"version", [](StoredHello &h) { h.Fields.Version = 9; }},
        {"no source", [](StoredHello &h) { h.Source.clear(); }},
        {"no life", [](StoredHello &h) { h.Fields.Incarnation = 0; }},
        {"impossible life", [](StoredHello &h) { h.Fields.Incarnation = NoHigherExists; }},
        {"impossible own life", [](StoredHello &h) { h.Fields.YourIncarnation = NoHigherExists; }},
        {"no clock", [](StoredHello &h) { h.Fields.Clock = 0; }},
        {"negative time", [](StoredHello &h) { h.Fields.Time = -1; }},
    };
    for (const auto &[what, spoil] : spoils)
    {
        StoredHello hello = b.Hello();
        spoil(hello);
        ExpectDropped(hello, what);
    }
}

TEST_F(MalformedInput, what_is_meant_for_another_node_is_dropped)
{
    const std::string before = a.Node->Describe();
    StoredData data = b.Data(3, {"3"}, a.Now);
    data.Destination = "c";
    a.Hear(data);
    StoredAck ack = b.Ack(1);
    ack.Source = "c";
    a.Hear(ack);
    StoredHello hello = b.Hello();
    hello.Destination = "c";
    a.Hear(hello);
    EXPECT_EQ(a.Node->Counters().NotForUs, 3U);
    EXPECT_EQ(a.Node->Describe(), before);
}

TEST_F(MalformedInput, an_acknowledgement_of_an_unknown_link_only_tells_of_the_peer)
{
    StoredAck ack = b.Ack(1);
    ack.Queue = "other";
    a.Hear(ack);
    EXPECT_EQ(a.Node->Counters().NoSuchLink, 1U);
    EXPECT_TRUE(a.TakeOutcomes().empty());
    b.Life += 1;
    ack = b.Ack(1);
    ack.Queue = "other";
    a.Hear(ack);
    EXPECT_EQ(a.Node->Counters().PeerRestarts, 1U);
}

TEST(LinkLimits, datagrams_of_too_many_peers_and_links_are_dropped)
{
    LinkSettings settings;
    settings.MaxPeers = 1;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    PlayedPeer b;
    a.Hear(b.Data(1, {"1"}, a.Now));
    const std::string before = a.Node->Describe();
    StoredData otherQueue = b.Data(1, {"1"}, a.Now);
    otherQueue.Queue = "other";
    a.Hear(otherQueue);
    EXPECT_EQ(a.Node->Counters().TooManyLinks, 1U);
    StoredData otherPeer = b.Data(1, {"1"}, a.Now);
    otherPeer.Source = "c";
    a.Hear(otherPeer);
    StoredHello hello = b.Hello();
    hello.Source = "d";
    a.Hear(hello);
    EXPECT_EQ(a.Node->Counters().TooManyPeers, 2U);
    EXPECT_EQ(a.Node->Describe(), before);
}

TEST(LinkLimits, messages_for_too_many_peers_and_links_are_refused)
{
    LinkSettings settings;
    settings.MaxPeers = 1;
    settings.MaxLinksPerPeer = 1;
    NodeUnderTest a(settings);
    EXPECT_NE(a.Enqueue("1"), 0U);
    EXPECT_EQ(a.Node->Enqueue("b", "other", "T", {}, a.Now).Refusal, LinkRefusal::TooManyLinks);
    EXPECT_EQ(a.Node->Enqueue("c", "q", "T", {}, a.Now).Refusal, LinkRefusal::TooManyPeers);
    EXPECT_FALSE(a.Node->AddPeer("c", a.Now));
    EXPECT_EQ(a.Node->Counters().RefusedTooMany, 2U);
}

TEST(LinkLimits, settings_and_options_out_of_range_are_programming_errors)
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
