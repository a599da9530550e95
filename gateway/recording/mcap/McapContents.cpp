#include "recording/mcap/McapContents.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "recording/mcap/ChunkReader.h"
#include "recording/mcap/Crc32.h"
#include "recording/mcap/RecordCodec.h"
#include "recording/mcap/RecordScanner.h"

namespace Rabit::Mcap
{
namespace
{

constexpr std::size_t FooterSize = RecordHead + 20;

// Bytes that the entries take in memory besides their texts.
std::size_t OverheadOf(const TextMap &values)
{
    return values.size() * 2 * sizeof(std::string);
}

std::string At(std::uint64_t offset)
{
    return " at byte " + std::to_string(offset);
}

// Reads a file from the beginning to the end.
class Scan
{
public:
    explicit Scan(ByteSource &source) : _source(source) {}

    Contents Run()
    {
        RecordScanner scanner(_source);
        while (const auto record = scanner.Next())
        {
            if (record->IsPassedOver)
            {
                _contents.AddProblem("a record" + At(record->Offset) + " is larger than 256 MiB");
                continue;
            }
            if (!_inSummary)
            {
                Take(*record);
            }
        }
        _contents.GoodUntil = scanner.GoodUntil();
        switch (scanner.HowItEnded())
        {
            case RecordScanner::End::Whole:
            case RecordScanner::End::NotYet:
                _contents.GoodUntil = _source.Size();
                break;
            case RecordScanner::End::Truncated:
                _contents.AddProblem("the file was not ended in order; the last whole record ends" +
                                     At(_contents.GoodUntil) + " of " + std::to_string(_source.Size()));
                break;
            case RecordScanner::End::Damaged:
                _contents.AddProblem(_contents.GoodUntil == 0
                                         ? "this is no MCAP file"
                                         : "there is no record" + At(_contents.GoodUntil) + " of " +
                                               std::to_string(_source.Size()));
                break;
        }
        Count();
        return std::move(_contents);
    }

private:
    void Take(const RecordScanner::Record &record)
    {
        bool good = true;
        switch (static_cast<Opcode>(record.Code))
        {
            case Opcode::Header:
                good = TakeIf(ReadHeader(record.Content),
                              [this](Header &&header) { _contents.Header = std::move(header); });
                break;
            case Opcode::Schema:
            case Opcode::Channel:
                good = TakeDefinition(record.Code, record.Content);
                break;
            case Opcode::Message:
                good = TakeMessage(record.Content);
                ++_outside;
                break;
            case Opcode::Chunk:
                TakeChunk(record);
                break;
            case Opcode::Attachment:
                good = TakeIf(ReadAttachment(record.Content),
                              [this, &record](Attachment &&attachment)
                              {
                                  _contents.Attachments.push_back(
                                      {record.Offset, record.Length, attachment.LogTime,
                                       attachment.CreateTime, attachment.Data.size(),
                                       std::move(attachment.Name), std::move(attachment.MediaType)});
                              });
                break;
            case Opcode::Metadata:
                good = TakeMetadata(record.Content);
                break;
            case Opcode::DataEnd:
                _inSummary = true;
                break;
            default:  // indexes, and what the format may get later
                break;
        }
        if (!good)
        {
            _contents.AddProblem("the record" + At(record.Offset) + " is malformed");
        }
    }

    template <typename T, typename Use>
    static bool TakeIf(std::optional<T> &&record, Use use)
    {
        if (record)
        {
            use(std::move(*record));
        }
        return record.has_value();
    }

    bool TakeDefinition(std::uint8_t code, ByteView content)
    {
        if (code == static_cast<std::uint8_t>(Opcode::Schema))
        {
            auto schema = ReadSchema(content);
            return schema && _contents.AddDefinition(std::move(*schema));
        }
        auto channel = ReadChannel(content);
        return channel && _contents.AddDefinition(std::move(*channel));
    }

    bool TakeMetadata(ByteView content)
    {
        auto metadata = ReadMetadata(content);
        return metadata && _contents.AddMetadata(std::move(*metadata), content.size());
    }

    bool TakeMessage(ByteView content)
    {
        const auto message = ReadMessage(content);
        if (!message)
        {
            return false;
        }
        Statistics &statistics = _contents.Statistics;
        statistics.StartTime = statistics.MessageCount == 0
                                   ? message->LogTime
                                   : std::min(statistics.StartTime, message->LogTime);
        statistics.EndTime = std::max(statistics.EndTime, message->LogTime);
        ++statistics.MessageCount;
        ++statistics.ChannelMessageCounts[message->ChannelId];
        return true;
    }

    void TakeChunk(const RecordScanner::Record &record)
    {
        const auto chunk = ReadChunk(record.Content);
        ByteView records;
        const std::string reason = chunk ? OpenChunk(*chunk, _room, records) : "it is malformed";
        if (!reason.empty())
        {
            _contents.AddProblem("the chunk" + At(record.Offset) + " cannot be read: " + reason);
            return;
        }
        RecordIterator inner(records);
        bool good = true;
        while (const auto next = inner.Next())
        {
            const bool isMessage = next->Code == static_cast<std::uint8_t>(Opcode::Message);
            const bool isDefinition = next->Code == static_cast<std::uint8_t>(Opcode::Schema) ||
                                      next->Code == static_cast<std::uint8_t>(Opcode::Channel);
            good = good && (!isMessage || TakeMessage(next->Content)) &&
                   (!isDefinition || TakeDefinition(next->Code, next->Content));
        }
        if (!good || !inner.WasGood())
        {
            _contents.AddProblem("the chunk" + At(record.Offset) + " has malformed records");
        }
        ChunkIndex index;
        index.StartTime = chunk->StartTime;
        index.EndTime = chunk->EndTime;
        index.Offset = record.Offset;
        index.Length = record.Length;
        index.Compression = chunk->Compression;
        index.CompressedSize = chunk->Records.size();
        index.UncompressedSize = chunk->UncompressedSize;
        _contents.Chunks.push_back(std::move(index));
    }

    void Count()
    {
        Statistics &statistics = _contents.Statistics;
        statistics.SchemaCount = static_cast<std::uint16_t>(_contents.Schemas.size());
        statistics.ChannelCount = static_cast<std::uint32_t>(_contents.Channels.size());
        statistics.ChunkCount = static_cast<std::uint32_t>(_contents.Chunks.size());
        statistics.AttachmentCount = static_cast<std::uint32_t>(_contents.Attachments.size());
        statistics.MetadataCount = static_cast<std::uint32_t>(_contents.MetadataRecords.size());
        if (_outside > 0)
        {
            _contents.AddProblem(std::to_string(_outside) +
                                 " messages are outside of chunks, and can only be read by `recover`");
        }
    }

    ByteSource &_source;
    Contents _contents;
    Bytes _room;
    std::uint64_t _outside = 0;
    bool _inSummary = false;
};

std::optional<Bytes> ReadPart(ByteSource &source, std::uint64_t offset, std::uint64_t length)
{
    const std::uint64_t size = source.Size();
    if (length > RecordScanner::LargestRecord || offset > size || length > size - offset)
    {
        return std::nullopt;
    }
    Bytes bytes(static_cast<std::size_t>(length));
    return source.Read(offset, bytes) ? std::optional(std::move(bytes)) : std::nullopt;
}

// The summary and what of the footer is covered by its CRC; nothing if the file was not ended in order.
std::optional<Bytes> ReadSummary(ByteSource &source)
{
    const std::uint64_t size = source.Size();
    if (size < 2 * Magic.size() + FooterSize)
    {
        return std::nullopt;
    }
    const auto end = ReadPart(source, size - Magic.size() - FooterSize, FooterSize + Magic.size());
    const auto begin = ReadPart(source, 0, Magic.size());
    if (!end || !begin || !std::equal(Magic.begin(), Magic.end(), begin->begin()) ||
        !std::equal(Magic.begin(), Magic.end(), end->begin() + FooterSize))
    {
        return std::nullopt;
    }
    const auto record = RecordIterator(*end).Next();
    const auto footer = record && record->Code == static_cast<std::uint8_t>(Opcode::Footer)
                            ? ReadFooter(record->Content)
                            : std::nullopt;
    const std::uint64_t footerAt = size - Magic.size() - FooterSize;
    if (!footer || footer->SummaryStart == 0 || footer->SummaryStart > footerAt)
    {
        return std::nullopt;
    }
    constexpr std::size_t covered = FooterSize - sizeof footer->SummaryCrc;
    auto summary = ReadPart(source, footer->SummaryStart, footerAt - footer->SummaryStart + covered);
    if (!summary || (footer->SummaryCrc != 0 && Crc32(*summary) != footer->SummaryCrc))
    {
        return std::nullopt;
    }
    summary->resize(summary->size() - covered);
    return summary;
}

bool TakeSummary(ByteSource &source, ByteView summary, Contents &contents)
{
    RecordIterator records(summary);
    bool hasStatistics = false;
    while (const auto record = records.Next())
    {
        switch (static_cast<Opcode>(record->Code))
        {
            case Opcode::Schema:
            {
                auto schema = ReadSchema(record->Content);
                if (!schema || !contents.AddDefinition(std::move(*schema)))
                {
                    return false;
                }
                break;
            }
            case Opcode::Channel:
            {
                auto channel = ReadChannel(record->Content);
                if (!channel || !contents.AddDefinition(std::move(*channel)))
                {
                    return false;
                }
                break;
            }
            case Opcode::ChunkIndex:
            {
                auto index = ReadChunkIndex(record->Content);
                if (!index)
                {
                    return false;
                }
                contents.Chunks.push_back(std::move(*index));
                break;
            }
            case Opcode::AttachmentIndex:
            {
                auto index = ReadAttachmentIndex(record->Content);
                if (!index)
                {
                    return false;
                }
                contents.Attachments.push_back(std::move(*index));
                break;
            }
            case Opcode::MetadataIndex:
            {
                const auto index = ReadMetadataIndex(record->Content);
                const auto bytes = index ? ReadPart(source, index->Offset, index->Length) : std::nullopt;
                const auto inner = bytes ? RecordIterator(*bytes).Next() : std::nullopt;
                auto metadata = inner && inner->Code == static_cast<std::uint8_t>(Opcode::Metadata)
                                    ? ReadMetadata(inner->Content)
                                    : std::nullopt;
                if (!metadata || !contents.AddMetadata(std::move(*metadata), bytes->size()))
                {
                    return false;
                }
                break;
            }
            case Opcode::Statistics:
            {
                auto statistics = ReadStatistics(record->Content);
                if (!statistics)
                {
                    return false;
                }
                contents.Statistics = std::move(*statistics);
                hasStatistics = true;
                break;
            }
            default:
                break;
        }
    }
    return records.WasGood() && hasStatistics &&
           (contents.Statistics.MessageCount == 0 || !contents.Chunks.empty());
}

}  // namespace

void Contents::AddProblem(std::string problem)
{
    if (Problems.size() < MostProblems)
    {
        Problems.push_back(std::move(problem));
    }
}

bool Contents::AddMetadata(Metadata metadata, std::size_t recordBytes)
{
    if (!HasRoomFor(recordBytes + OverheadOf(metadata.Values)))
    {
        return false;
    }
    MetadataRecords.push_back(std::move(metadata));
    return true;
}

bool Contents::HasRoomFor(std::size_t bytes)
{
    _definitionBytes += std::min(bytes, MostDefinitionBytes);
    return _definitionBytes <= MostDefinitionBytes;
}

bool Contents::AddDefinition(Schema schema)
{
    if (Schemas.count(schema.Id) != 0)
    {
        return true;  // it is repeated
    }
    if (!HasRoomFor(schema.Data.size() + schema.Name.size()))
    {
        return false;
    }
    const std::uint16_t id = schema.Id;
    Schemas.emplace(id, std::move(schema));
    return true;
}

bool Contents::AddDefinition(Channel channel)
{
    if (Channels.count(channel.Id) != 0)
    {
        return true;
    }
    std::size_t bytes = channel.Topic.size() + OverheadOf(channel.Metadata);
    for (const auto &[key, value] : channel.Metadata)
    {
        bytes += key.size() + value.size();
    }
    if (!HasRoomFor(bytes))
    {
        return false;
    }
    const std::uint16_t id = channel.Id;
    Channels.emplace(id, std::move(channel));
    return true;
}

Contents ScanContents(ByteSource &source)
{
    return Scan(source).Run();
}

Contents ReadContents(ByteSource &source)
{
    if (const auto summary = ReadSummary(source))
    {
        Contents contents;
        if (TakeSummary(source, *summary, contents))
        {
            RecordScanner scanner(source);
            const auto first = scanner.Next();
            auto header = first && first->Code == static_cast<std::uint8_t>(Opcode::Header)
                              ? ReadHeader(first->Content)
                              : std::nullopt;
            contents.Header = header ? std::move(*header) : Header{};
            contents.IsIndexed = true;
            contents.GoodUntil = source.Size();
            return contents;
        }
    }
    return ScanContents(source);
}

TextMap MetadataOf(const Contents &contents, const std::string &name)
{
    TextMap values;
    for (const Metadata &metadata : contents.MetadataRecords)
    {
        values = metadata.Name == name ? metadata.Values : values;
    }
    return values;
}

std::string ValueOf(const TextMap &values, const std::string &key)
{
    const auto found = values.find(key);
    return found == values.end() ? "" : found->second;
}

}  // namespace Rabit::Mcap
