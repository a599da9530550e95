#include <rabit/mcap/McapWriter.h>

#include <rabit/mcap/RecordCodec.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "recording/mcap/ChunkBuilder.h"

namespace Rabit::Mcap
{
namespace
{

constexpr std::size_t MostNumbers = std::numeric_limits<std::uint16_t>::max();

}  // namespace

McapWriter::McapWriter(ByteSink &sink, const Options &options)
    : _sink(sink),
      _small(std::make_unique<ChunkBuilder>(options.Compresses)),
      _large(std::make_unique<ChunkBuilder>(false))
{
    Bytes bytes(Magic.begin(), Magic.end());
    Append(bytes, Header{options.Profile, options.Library});
    Write(bytes);
}

McapWriter::~McapWriter() = default;

std::uint16_t McapWriter::AddSchema(const std::string &name, const std::string &encoding,
                                    const std::string &data)
{
    if (_schemas.size() >= MostNumbers)
    {
        return 0;
    }
    const auto id = static_cast<std::uint16_t>(_schemas.size() + 1);
    _schemas.push_back({{id, name, encoding, data}, {}});
    ++_statistics.SchemaCount;
    return id;
}

std::optional<std::uint16_t> McapWriter::AddChannel(std::uint16_t schema, const std::string &topic,
                                                    const std::string &encoding, const TextMap &metadata)
{
    if (schema > _schemas.size())
    {
        throw std::invalid_argument("McapWriter: no such schema");
    }
    if (_channels.size() >= MostNumbers)
    {
        return std::nullopt;
    }
    const auto id = static_cast<std::uint16_t>(_channels.size());
    _channels.push_back({{id, schema, topic, encoding, metadata}, {}});
    _counts.push_back(0);
    ++_statistics.ChannelCount;
    return id;
}

bool McapWriter::Add(const Message &message)
{
    if (message.ChannelId >= _channels.size())
    {
        throw std::invalid_argument("McapWriter: no such channel");
    }
    if (!_good || message.Data.size() > LargestMessage)
    {
        return false;
    }
    const bool isLarge = message.Data.size() >= LargeMessage;
    ChunkBuilder &chunk = isLarge ? *_large : *_small;
    const std::size_t full = isLarge ? LargeChunkSize : ChunkSize;
    // Both, so that the file has all messages that were added before those of a chunk that follows.
    if (chunk.Size() + message.Data.size() > full && !FinishChunks())
    {
        return false;
    }
    Introduce(_channels[message.ChannelId], chunk, isLarge ? &Places::Large : &Places::Small);
    chunk.Add(message);
    _statistics.StartTime =
        _statistics.MessageCount == 0 ? message.LogTime : std::min(_statistics.StartTime, message.LogTime);
    _statistics.EndTime = std::max(_statistics.EndTime, message.LogTime);
    ++_statistics.MessageCount;
    ++_counts[message.ChannelId];
    return true;
}

// Writes a channel and its schema once into each kind of chunk, since one kind is read without the other.
void McapWriter::Introduce(KnownChannel &channel, ChunkBuilder &chunk, bool Places::*place)
{
    if (channel.In.*place)
    {
        return;
    }
    if (channel.Record.SchemaId != 0)
    {
        KnownSchema &schema = _schemas[channel.Record.SchemaId - std::size_t{1}];
        if (!(schema.In.*place))
        {
            chunk.Add(schema.Record);
            schema.In.*place = true;
        }
    }
    chunk.Add(channel.Record);
    channel.In.*place = true;
}

bool McapWriter::AddMetadata(const Metadata &metadata)
{
    Bytes bytes;
    Append(bytes, metadata);
    Append(_metadataIndexes, MetadataIndex{_offset, bytes.size(), metadata.Name});
    ++_statistics.MetadataCount;
    return Write(bytes);
}

bool McapWriter::AddAttachment(const Attachment &attachment)
{
    Bytes bytes;
    Append(bytes, attachment);
    Append(_attachmentIndexes,
           AttachmentIndex{_offset, bytes.size(), attachment.LogTime, attachment.CreateTime,
                           attachment.Data.size(), attachment.Name, attachment.MediaType});
    ++_statistics.AttachmentCount;
    return Write(bytes);
}

bool McapWriter::FinishChunks()
{
    return FinishChunk(*_small) && FinishChunk(*_large);
}

bool McapWriter::FinishChunk(ChunkBuilder &chunk)
{
    if (chunk.IsEmpty())
    {
        return _good;
    }
    const ChunkBuilder::Written written = chunk.Finish(_offset);
    const bool good = Write(written.Head) && Write(written.Records) && Write(written.Indexes);
    Append(_chunkIndexes, written.Index);
    ++_statistics.ChunkCount;
    chunk.Clear();
    return good;
}

bool McapWriter::Finish()
{
    FinishChunks();
    Bytes end;
    AppendDataEnd(end);
    Write(end);

    Footer footer;
    footer.SummaryStart = _offset;
    Bytes summary;
    std::vector<SummaryOffset> groups;
    AppendSummary(summary, groups);
    footer.SummaryOffsetStart = _offset + summary.size();
    for (const SummaryOffset &group : groups)
    {
        Append(summary, group);
    }
    Bytes last;
    AppendFooter(last, footer, summary);
    last.insert(last.end(), Magic.begin(), Magic.end());
    return Write(summary) && Write(last);
}

void McapWriter::AppendSummary(Bytes &to, std::vector<SummaryOffset> &groups) const
{
    const auto group = [this, &to, &groups](Opcode opcode, const auto &append)
    {
        const std::size_t before = to.size();
        append();
        if (to.size() > before)
        {
            groups.push_back({opcode, _offset + before, to.size() - before});
        }
    };
    const auto insert = [&to](const Bytes &bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); };
    group(Opcode::Schema,
          [this, &to]
          {
              for (const KnownSchema &schema : _schemas)
              {
                  Append(to, schema.Record);
              }
          });
    group(Opcode::Channel,
          [this, &to]
          {
              for (const KnownChannel &channel : _channels)
              {
                  Append(to, channel.Record);
              }
          });
    group(Opcode::Statistics,
          [this, &to]
          {
              Statistics statistics = _statistics;
              for (std::size_t channel = 0; channel < _counts.size(); ++channel)
              {
                  statistics.ChannelMessageCounts[static_cast<std::uint16_t>(channel)] = _counts[channel];
              }
              Append(to, statistics);
          });
    group(Opcode::ChunkIndex, [this, &insert] { insert(_chunkIndexes); });
    group(Opcode::AttachmentIndex, [this, &insert] { insert(_attachmentIndexes); });
    group(Opcode::MetadataIndex, [this, &insert] { insert(_metadataIndexes); });
}

std::uint64_t McapWriter::BytesToWrite() const
{
    return _offset + _small->Size() + _large->Size();
}

bool McapWriter::Write(ByteView bytes)
{
    _good = _good && _sink.Write(bytes);
    if (_good)
    {
        _offset += bytes.size();
    }
    return _good;
}

}  // namespace Rabit::Mcap
