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

// A bounded buffer between the threads that record and the thread that writes. Put never waits for the
// disk: an item without room is dropped and counted as lost. Large messages, pictures as a rule, may take
// three quarters of the room, so that others are not pushed out. Thread-safe.
class RecordingInbox
{
public:
    // Bytes that an item takes beside its data.
    static constexpr std::size_t ItemSize = sizeof(RecordingItem) + 32;

    explicit RecordingInbox(std::size_t mostBytes) : _mostBytes(mostBytes) {}

    // Returns the number by which items name the stream.
    std::uint32_t AddStream(RecordingStream stream);
    // False if there was no room, the item is too large or the inbox is closed: the item counts as lost.
    bool Put(RecordingItem item);
    // Sets values that are written into each file under that name, in place of former ones.
    void SetMetadata(const std::string &name, Mcap::TextMap values);
    // Tells of an event, for which a black box is written.
    void Happened(std::uint64_t logTime);
    // Counts messages of a stream that were lost before they came here.
    void AddLost(std::uint32_t stream, std::uint64_t count);

    struct Batch
    {
        std::vector<std::shared_ptr<const RecordingStream>> NewStreams;
        std::size_t FirstNewStream = 0;  // the number of the first of them
        std::vector<RecordingItem> Items;
        std::vector<Mcap::Metadata> Metadata;  // that was set
        // Lost messages by stream, since the beginning; empty if nothing changed.
        std::vector<std::uint64_t> Lost;
        std::vector<std::uint64_t> Events;  // log times of events; of many the last
        std::size_t Bytes = 0;              // that it takes of the room
        bool IsEnd = false;                 // there will be nothing more
    };
    // Waits until half of the room is taken, or for `wait`. Items that are given out take room until Done.
    void Take(Batch &batch, std::chrono::milliseconds wait);
    void Done(const Batch &batch);
    // From now on Put refuses items, and Take does not wait.
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
    std::size_t _bytes = 0;    // of waiting items, and of those given out
    std::size_t _waiting = 0;  // of waiting items
    bool _anyLost = false;
    bool _closed = false;
};

}  // namespace Rabit
