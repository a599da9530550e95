#pragma once

#include <rabit/mcap/McapRecords.h>

#include <vector>

#include "recording/mcap/Zstd.h"

namespace Rabit::Mcap
{

// Builds one chunk after the other: schemas, channels and messages, then an index of the messages of each
// channel. Keeps its memory from chunk to chunk. Not thread-safe.
class ChunkBuilder
{
public:
    // If `compresses`, a chunk is compressed where that makes it smaller.
    explicit ChunkBuilder(bool compresses) : _compresses(compresses) {}

    void Add(const Schema &schema);
    void Add(const Channel &channel);
    void Add(const Message &message);

    bool IsEmpty() const { return _records.empty(); }
    std::size_t Size() const { return _records.size(); }

    // The parts of a chunk in the order in which they are to be written.
    struct Written
    {
        ByteView Head;
        ByteView Records;
        ByteView Indexes;
        ChunkIndex Index;
    };
    // Returns the chunk as it must be written at that offset of the file. Valid until Clear, which begins
    // the next chunk.
    Written Finish(std::uint64_t offset);
    void Clear();

private:
    bool _compresses;
    ZstdCompressor _compressor;
    Bytes _records;
    Bytes _compressed;
    Bytes _head;
    Bytes _indexes;
    std::vector<MessageIndex> _byChannel;  // by number of the channel
    std::vector<std::uint16_t> _channels;  // that have messages in this chunk
    std::uint64_t _start = 0;
    std::uint64_t _end = 0;
};

}  // namespace Rabit::Mcap
