#include "recording/mcap/ChunkBuilder.h"

#include <rabit/mcap/RecordCodec.h>

#include <algorithm>

#include "recording/mcap/Crc32.h"

namespace Rabit::Mcap
{

void ChunkBuilder::Add(const Schema &schema)
{
    Append(_records, schema);
}

void ChunkBuilder::Add(const Channel &channel)
{
    Append(_records, channel);
}

void ChunkBuilder::Add(const Message &message)
{
    if (message.ChannelId >= _byChannel.size())
    {
        _byChannel.resize(message.ChannelId + std::size_t{1});
    }
    MessageIndex &index = _byChannel[message.ChannelId];
    _start = _channels.empty() ? message.LogTime : std::min(_start, message.LogTime);
    _end = std::max(_end, message.LogTime);
    if (index.Entries.empty())
    {
        index.ChannelId = message.ChannelId;
        _channels.push_back(message.ChannelId);
    }
    index.Entries.emplace_back(message.LogTime, _records.size());
    Append(_records, message);
}

ChunkBuilder::Written ChunkBuilder::Finish(std::uint64_t offset)
{
    Chunk chunk;
    chunk.StartTime = _start;
    chunk.EndTime = _end;
    chunk.UncompressedSize = _records.size();
    chunk.UncompressedCrc = Crc32(_records);
    chunk.Records = _records;
    if (_compresses && _compressor.Compress(_records, _compressed))
    {
        chunk.Compression = "zstd";
        chunk.Records = _compressed;
    }
    _head.clear();
    AppendChunkHead(_head, chunk);

    Written written;
    written.Index.StartTime = _start;
    written.Index.EndTime = _end;
    written.Index.Offset = offset;
    written.Index.Length = _head.size() + chunk.Records.size();
    written.Index.Compression = chunk.Compression;
    written.Index.CompressedSize = chunk.Records.size();
    written.Index.UncompressedSize = _records.size();
    _indexes.clear();
    for (const std::uint16_t channel : _channels)
    {
        written.Index.MessageIndexOffsets[channel] = offset + written.Index.Length + _indexes.size();
        Append(_indexes, _byChannel[channel]);
    }
    written.Index.MessageIndexLength = _indexes.size();
    written.Head = _head;
    written.Records = chunk.Records;
    written.Indexes = _indexes;
    return written;
}

void ChunkBuilder::Clear()
{
    _records.clear();
    for (const std::uint16_t channel : _channels)
    {
        _byChannel[channel].Entries.clear();
    }
    _channels.clear();
    _start = 0;
    _end = 0;
}

}  // namespace Rabit::Mcap
