// The codec of LinkData against the class that was generated for the same sample.
#include "wire/LinkDataCodec.h"

#include <gtest/gtest.h>
#include <rabit/idl/MessageType.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

using Bytes = std::vector<std::uint8_t>;
using Sample = Gateway::LinkDataSample;

const MessageType &Generated()
{
    return GatewayTopics::TypeOf<Sample>();
}

class Chance
{
public:
    explicit Chance(std::uint32_t seed) : _random(seed) {}
    std::size_t Below(std::size_t limit) { return _random() % limit; }
    std::uint64_t Number() { return _random(); }
    std::string Name(std::size_t longest) { return std::string(Below(longest + 1), 'n'); }
    Bytes Octets(std::size_t most)
    {
        Bytes bytes(Below(most + 1));
        std::generate(bytes.begin(), bytes.end(), [this] { return static_cast<std::uint8_t>(_random()); });
        return bytes;
    }

private:
    std::mt19937_64 _random;
};

Sample AnySample(Chance &chance)
{
    Sample sample;
    sample.version = static_cast<std::uint8_t>(chance.Number());
    sample.source = chance.Name(20);
    sample.destination = chance.Name(255);
    sample.queue = chance.Name(20);
    sample.sender_incarnation = chance.Number();
    sample.receiver_incarnation = chance.Number();
    sample.base = chance.Number();
    sample.first = chance.Number();
    sample.echo_clock = chance.Number();
    sample.echo_time = static_cast<std::int64_t>(chance.Number());
    sample.echo_held_for = static_cast<std::int64_t>(chance.Number());
    sample.sent_at = static_cast<std::int64_t>(chance.Number());
    sample.items.resize(chance.Below(6));
    for (Gateway::LinkItemSample &item : sample.items)
    {
        item.flags = static_cast<std::uint8_t>(chance.Number());
        item.ttl_left = static_cast<std::int64_t>(chance.Number());
        item.type = chance.Name(30);
        item.payload = chance.Octets(40);
    }
    return sample;
}

LinkData ViewOf(const Sample &sample)
{
    LinkData data;
    data.Version = sample.version;
    data.Source = sample.source;
    data.Destination = sample.destination;
    data.Queue = sample.queue;
    data.SenderIncarnation = sample.sender_incarnation;
    data.ReceiverIncarnation = sample.receiver_incarnation;
    data.Base = sample.base;
    data.First = sample.first;
    data.Echo = {sample.echo_clock, sample.echo_time, sample.echo_held_for};
    data.SentAt = sample.sent_at;
    for (const Gateway::LinkItemSample &item : sample.items)
    {
        data.Items.push_back({item.flags, item.ttl_left, item.type, item.payload});
    }
    return data;
}

Sample CopyOf(const LinkData &data)
{
    Sample sample;
    sample.version = data.Version;
    sample.source = data.Source;
    sample.destination = data.Destination;
    sample.queue = data.Queue;
    sample.sender_incarnation = data.SenderIncarnation;
    sample.receiver_incarnation = data.ReceiverIncarnation;
    sample.base = data.Base;
    sample.first = data.First;
    sample.echo_clock = data.Echo.Clock;
    sample.echo_time = data.Echo.Time;
    sample.echo_held_for = data.Echo.HeldFor;
    sample.sent_at = data.SentAt;
    for (const LinkItem &item : data.Items)
    {
        Gateway::LinkItemSample copy;
        copy.flags = item.Flags;
        copy.ttl_left = item.TtlLeft;
        copy.type = item.Type;
        copy.payload.assign(item.Payload.begin(), item.Payload.end());
        sample.items.push_back(copy);
    }
    return sample;
}

Bytes Serialized(const Sample &sample)
{
    Bytes bytes(Generated().SerializedSize(sample));
    EXPECT_EQ(Generated().Serialize(sample, bytes), bytes.size());
    return bytes;
}

Bytes Encoded(const LinkData &data)
{
    Bytes bytes(LinkDataCodec::EncodedSize(data), 0xee);
    EXPECT_TRUE(LinkDataCodec::Encode(data, bytes));
    return bytes;
}

TEST(LinkDataCodec, writes_the_bytes_that_the_generated_class_writes)
{
    Chance chance(1);
    for (int i = 0; i < 2000; ++i)
    {
        const Sample sample = AnySample(chance);
        ASSERT_EQ(Encoded(ViewOf(sample)), Serialized(sample)) << i;
    }
}

TEST(LinkDataCodec, reads_what_the_generated_class_writes)
{
    Chance chance(2);
    LinkData data;  // used again, as on the way
    for (int i = 0; i < 2000; ++i)
    {
        const Sample sample = AnySample(chance);
        const Bytes bytes = Serialized(sample);
        ASSERT_TRUE(LinkDataCodec::Decode(bytes, data)) << i;
        ASSERT_EQ(CopyOf(data), sample) << i;
    }
}

TEST(LinkDataCodec, refuses_damaged_bytes_exactly_when_the_generated_class_does)
{
    Chance chance(3);
    int refused = 0;
    for (int i = 0; i < 20000; ++i)
    {
        Bytes bytes = Serialized(AnySample(chance));
        if (chance.Below(2) == 0)
        {
            bytes.resize(chance.Below(bytes.size() + 1));
        }
        for (std::size_t flips = chance.Below(4); flips > 0 && !bytes.empty(); --flips)
        {
            bytes[chance.Below(bytes.size())] = static_cast<std::uint8_t>(chance.Number());
        }
        Sample expected;
        LinkData data;
        const bool good = Generated().Deserialize(bytes, expected);
        ASSERT_EQ(LinkDataCodec::Decode(bytes, data), good) << i;
        if (good)
        {
            ASSERT_EQ(CopyOf(data), expected) << i;
        }
        refused += good ? 0 : 1;
    }
    EXPECT_GT(refused, 5000);
    EXPECT_LT(refused, 19000);
}

TEST(LinkDataCodec, refuses_to_write_what_does_not_fit_the_type)
{
    const std::string tooLong(256, 'n');
    const auto refuses = [](const LinkData &data)
    {
        Bytes bytes(LinkDataCodec::EncodedSize(data));
        return !LinkDataCodec::Encode(data, bytes);
    };
    LinkData longName;
    longName.Source = tooLong;
    EXPECT_TRUE(refuses(longName));
    LinkData withZero;
    withZero.Queue = std::string_view("a\0b", 3);
    EXPECT_TRUE(refuses(withZero));
    LinkData manyItems;
    manyItems.Items.resize(257);
    EXPECT_TRUE(refuses(manyItems));
    manyItems.Items.resize(256);
    EXPECT_FALSE(refuses(manyItems));
}

TEST(LinkDataCodec, refuses_a_buffer_of_another_size)
{
    const LinkData data;
    Bytes bytes(LinkDataCodec::EncodedSize(data));
    EXPECT_FALSE(LinkDataCodec::Encode(data, std::span(bytes).first(bytes.size() - 1)));
    EXPECT_FALSE(LinkDataCodec::Encode(data, std::span(bytes).first(3)));
    EXPECT_TRUE(LinkDataCodec::Encode(data, bytes));
}

}  // namespace
}  // namespace Rabit
