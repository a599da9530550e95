// Link messages that own what they hold, for tests that keep datagrams.
#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Test
{

struct StoredItem
{
    std::uint8_t Flags = 0;
    std::int64_t TtlLeft = LinkNoExpiry;
    std::string Type;
    std::vector<std::uint8_t> Payload;
};

struct StoredData
{
    std::string Source, Destination, Queue;
    LinkData Fields;  // everything but names and items
    std::vector<StoredItem> Items;

    StoredData() = default;
    explicit StoredData(const LinkData &data)
        : Source(data.Source), Destination(data.Destination), Queue(data.Queue), Fields(data)
    {
        Fields.Items.clear();
        for (const LinkItem &item : data.Items)
        {
            Items.push_back({item.Flags, item.TtlLeft, std::string(item.Type),
                             std::vector<std::uint8_t>(item.Payload.begin(), item.Payload.end())});
        }
    }

    // Valid as long as this object is unchanged.
    LinkData View() const
    {
        LinkData data = Fields;
        data.Source = Source;
        data.Destination = Destination;
        data.Queue = Queue;
        for (const StoredItem &item : Items)
        {
            data.Items.push_back({item.Flags, item.TtlLeft, item.Type, item.Payload, nullptr});
        }
        return data;
    }
};

struct StoredAck
{
    std::string Source, Destination, Queue;
    LinkAck Fields;

    StoredAck() = default;
    explicit StoredAck(const LinkAck &ack)
        : Source(ack.Source), Destination(ack.Destination), Queue(ack.Queue), Fields(ack)
    {
    }

    LinkAck View() const
    {
        LinkAck ack = Fields;
        ack.Source = Source;
        ack.Destination = Destination;
        ack.Queue = Queue;
        return ack;
    }
};

struct StoredHello
{
    std::string Source, Destination;
    LinkHello Fields;

    StoredHello() = default;
    explicit StoredHello(const LinkHello &hello)
        : Source(hello.Source), Destination(hello.Destination), Fields(hello)
    {
    }

    LinkHello View() const
    {
        LinkHello hello = Fields;
        hello.Source = Source;
        hello.Destination = Destination;
        return hello;
    }
};

}  // namespace Rabit::Test
