// Link frames that own their contents, for tests that keep them.
#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Test
{

struct StoredItem
{
    LinkItem Fields;  // everything but the type and the payload
    std::string Type;
    std::vector<std::uint8_t> Payload;

    std::string Text() const { return {Payload.begin(), Payload.end()}; }
};

struct StoredFrame
{
    std::string Source, Destination, Queue;
    LinkFrame Fields;  // everything but names and items
    std::vector<StoredItem> Items;

    StoredFrame() = default;
    explicit StoredFrame(const LinkFrame &frame)
        : Source(frame.Source), Destination(frame.Destination), Queue(frame.Data.Queue), Fields(frame)
    {
        Fields.Data.Items.clear();
        for (const LinkItem &item : frame.Data.Items)
        {
            StoredItem &stored = Items.emplace_back();
            stored.Fields = item;
            stored.Fields.Owner = nullptr;
            stored.Type.assign(item.Type);
            stored.Payload.assign(item.Payload.begin(), item.Payload.end());
        }
    }

    LinkAck &Ack() { return Fields.Acks.at(0); }
    const LinkAck &Ack() const { return Fields.Acks.at(0); }

    // Valid as long as this object is unchanged.
    LinkFrame View() const
    {
        LinkFrame frame = Fields;
        frame.Source = Source;
        frame.Destination = Destination;
        frame.Data.Queue = Queue;
        for (const StoredItem &stored : Items)
        {
            LinkItem &item = frame.Data.Items.emplace_back(stored.Fields);
            item.Type = stored.Type;
            item.Payload = stored.Payload;
        }
        return frame;
    }
};

}  // namespace Rabit::Test
