#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "recording/RecordingItem.h"

namespace Rabit
{

// What is to be recorded, between those who have it and the thread that writes it: a bounded amount of
// memory. Who puts something in never waits for the disk; what has no room is not kept, and counted.
// Large messages, pictures as a rule, may take three quarters of the room, so that they push out nothing
// else. Thread-safe.
class RecordingInbox
{
public:
    // What an item takes beside its data.
    static constexpr std::size_t ItemSize = sizeof(RecordingItem) + 32;

    explicit RecordingInbox(std::size_t mostBytes) : _mostBytes(mostBytes) {}

    // The number by which items name it.
    std::uint32_t AddStream(RecordingStream stream);
    // False if there was no room.
    bool Put(RecordingItem item);
    // What is written into each file, under that name; it takes the place of what had that name.
    void SetMetadata(const std::string &name, Mcap::TextMap values);
    // Something happened, for which a black box is written.
    void Happened(std::uint64_t logTime);
    // Something of a stream was lost before it came here.
    void AddLost(std::uint32_t stream, std::uint64_t count);

    struct Batch
    {
        std::vector<std::shared_ptr<const RecordingStream>> NewStreams;
        std::size_t FirstNewStream = 0;  // the number of the first of them
        std::vector<RecordingItem> Items;
        std::vector<Mcap::Metadata> Metadata;  // that was set
        // By stream, since the beginning; empty: as it was.
        std::vector<std::uint64_t> Lost;
        std::vector<std::uint64_t> Events;  // when something happened, log times; of many the last
        std::size_t Bytes = 0;              // that it takes of the room
        bool IsEnd = false;                 // there will be nothing more
    };
    // Waits until half of the room is taken, or for so long. What was given out takes room until Done.
    void Take(Batch &batch, std::chrono::milliseconds wait);
    void Done(const Batch &batch);
    // Nothing is taken in any more, and nobody waits.
    void Close();

    static std::size_t SizeOf(const RecordingItem &item) { return ItemSize + item.Data.capacity(); }

private:
    const std::size_t _mostBytes;
    std::mutex _mutex;
    std::condition_variable _changed;
    std::vector<std::shared_ptr<const RecordingStream>> _newStreams;
    std::vector<RecordingItem> _items;
    std::vector<Mcap::Metadata> _metadata;
    std::vector<std::uint64_t> _lost;  // by stream: as many as there are streams
    std::optional<std::uint64_t> _event;
    std::size_t _bytes = 0;    // of what is there, and of what is given out
    std::size_t _waiting = 0;  // of what is there
    bool _anyLost = false;
    bool _closed = false;
};

}  // namespace Rabit
