#include <rabit/mcap/McapContents.h>

#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "recording/mcap/Crc32.h"

namespace Rabit::Mcap
{
namespace
{

constexpr std::size_t FooterSize = RecordHead + 20;

// Bytes that these take in memory, about.
std::size_t SizeOf(const TextMap &values)
{
    std::size_t bytes = 0;
    for (const auto &[key, value] : values)
    {
        bytes += TextEntrySize + key.size() + value.size();
    }
    return bytes;
}

std::size_t SizeOf(const Schema &schema)
{
    return sizeof schema + schema.Name.size() + schema.Encoding.size() + schema.Data.size();
}

std::size_t SizeOf(const Channel &channel)
{
    return sizeof channel + channel.Topic.size() + channel.MessageEncoding.size() + SizeOf(channel.Metadata);
}

std::size_t SizeOf(const Metadata &metadata)
{
    return sizeof metadata + metadata.Name.size() + SizeOf(metadata.Values);
}

std::size_t SizeOf(const ChunkIndex &chunk)
{
    constexpr std::size_t offsetEntry = 64;  // the node of the map
    return sizeof chunk + chunk.Compression.size() + chunk.MessageIndexOffsets.size() * offsetEntry;
}

std::size_t SizeOf(const AttachmentIndex &attachment)
{
    return sizeof attachment + attachment.Name.size() + attachment.MediaType.size();
}

bool Take(std::size_t bytes, std::size_t &left)
{
    const bool fits = bytes <= left;
    left -= fits ? bytes : 0;
    return fits;
}

// Adds the record if there is room for it; false if there is none.
template <typename Record>
bool Append(Record record, std::vector<Record> &records, std::size_t &left)
{
    const bool fits = Take(SizeOf(record), left);
    if (fits)
    {
        records.push_back(std::move(record));
    }
    return fits;
}

// The same for a definition, which a file may repeat.
template <typename Record>
bool Define(Record record, std::map<std::uint16_t, Record> &records, std::size_t &left)
{
    const std::uint16_t id = record.Id;
    return records.contains(id) ||
           (Take(SizeOf(record), left) && records.emplace(id, std::move(record)).second);
}

std::string At(std::uint64_t offset)
{
    return " at byte " + std::to_string(offset);
}

// Adds the record that was read; false if there is none, or it is beyond the limits.
template <typename T>
bool AddIf(std::optional<T> &&record, Contents &contents)
{
    return record && contents.Add(std::move(*record));
}

// Reads a file from the beginning to the end.
class Scan
{
public:
    Scan(ByteSource &source, const ContentsLimits &limits) : _source(source), _contents(limits) {}

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
                good = TakeHeader(record.Content);
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
                good = TakeAttachment(record);
                break;
            case Opcode::Metadata:
                good = AddIf(Read<Metadata>(record.Content), _contents);
                break;
            case Opcode::DataEnd:
                _inSummary = true;
                break;
            default:  // indexes, and what the format may get later
                break;
        }
        if (!good)
        {
            _contents.AddProblem("the record" + At(record.Offset) + " is malformed, or too much to hold");
        }
    }

    bool TakeHeader(ByteView content)
    {
        auto header = Read<Header>(content);
        if (header)
        {
            _contents.Header = std::move(*header);
        }
        return header.has_value();
    }

    bool TakeAttachment(const RecordScanner::Record &record)
    {
        auto attachment = Read<Attachment>(record.Content);
        return attachment &&
               _contents.Add(AttachmentIndex{record.Offset, record.Length, attachment->LogTime,
                                             attachment->CreateTime, attachment->Data.size(),
                                             std::move(attachment->Name), std::move(attachment->MediaType)});
    }

    bool TakeDefinition(std::uint8_t code, ByteView content)
    {
        return code == static_cast<std::uint8_t>(Opcode::Schema) ? AddIf(Read<Schema>(content), _contents)
                                                                 : AddIf(Read<Channel>(content), _contents);
    }

    bool TakeMessage(ByteView content)
    {
        const auto message = Read<Message>(content);
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
        const std::uint64_t time = message->LogTime;
        auto &span = _contents.Spans.try_emplace(message->ChannelId, time, time).first->second;
        span = {std::min(span.first, time), std::max(span.second, time)};
        return true;
    }

    void TakeChunk(const RecordScanner::Record &record)
    {
        const auto chunk = Read<Chunk>(record.Content);
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
            _contents.AddProblem("the chunk" + At(record.Offset) +
                                 " has records that are malformed, or too much to hold");
        }
        ChunkIndex index;
        index.StartTime = chunk->StartTime;
        index.EndTime = chunk->EndTime;
        index.Offset = record.Offset;
        index.Length = record.Length;
        index.Compression = chunk->Compression;
        index.CompressedSize = chunk->Records.size();
        index.UncompressedSize = chunk->UncompressedSize;
        if (!_isFull && !_contents.Add(std::move(index)))
        {
            _isFull = true;
            _contents.AddProblem("there are too many chunks: messages from the one" + At(record.Offset) +
                                 " on can only be read by `recover`");
        }
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
    bool _isFull = false;  // a chunk was left out
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
                            ? Read<Footer>(record->Content)
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

std::optional<Metadata> ReadMetadataAt(ByteSource &source, const std::optional<MetadataIndex> &index)
{
    const auto bytes = index ? ReadPart(source, index->Offset, index->Length) : std::nullopt;
    const auto record = bytes ? RecordIterator(*bytes).Next() : std::nullopt;
    return record && record->Code == static_cast<std::uint8_t>(Opcode::Metadata)
               ? Read<Metadata>(record->Content)
               : std::nullopt;
}

bool TakeSummary(ByteSource &source, ByteView summary, Contents &contents)
{
    RecordIterator records(summary);
    bool hasStatistics = false;
    while (const auto record = records.Next())
    {
        bool good = true;
        switch (static_cast<Opcode>(record->Code))
        {
            case Opcode::Schema:
                good = AddIf(Read<Schema>(record->Content), contents);
                break;
            case Opcode::Channel:
                good = AddIf(Read<Channel>(record->Content), contents);
                break;
            case Opcode::ChunkIndex:
                good = AddIf(Read<ChunkIndex>(record->Content), contents);
                break;
            case Opcode::AttachmentIndex:
                good = AddIf(Read<AttachmentIndex>(record->Content), contents);
                break;
            case Opcode::MetadataIndex:
                good = AddIf(ReadMetadataAt(source, Read<MetadataIndex>(record->Content)), contents);
                break;
            case Opcode::Statistics:
            {
                auto statistics = Read<Statistics>(record->Content);
                good = hasStatistics = statistics.has_value();
                contents.Statistics = good ? std::move(*statistics) : Statistics{};
                break;
            }
            default:
                break;
        }
        if (!good)
        {
            return false;
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

bool Contents::Add(Schema schema)
{
    return Define(std::move(schema), Schemas, _limits.Definitions);
}

bool Contents::Add(Channel channel)
{
    return Define(std::move(channel), Channels, _limits.Definitions);
}

bool Contents::Add(Metadata metadata)
{
    return Append(std::move(metadata), MetadataRecords, _limits.Definitions);
}

bool Contents::Add(ChunkIndex chunk)
{
    return Append(std::move(chunk), Chunks, _limits.Indexes);
}

bool Contents::Add(AttachmentIndex attachment)
{
    return Append(std::move(attachment), Attachments, _limits.Indexes);
}

Contents ScanContents(ByteSource &source, const ContentsLimits &limits)
{
    return Scan(source, limits).Run();
}

Contents ReadContents(ByteSource &source, const ContentsLimits &limits)
{
    if (const auto summary = ReadSummary(source))
    {
        Contents contents(limits);
        if (TakeSummary(source, *summary, contents))
        {
            RecordScanner scanner(source);
            const auto first = scanner.Next();
            auto header = first && first->Code == static_cast<std::uint8_t>(Opcode::Header)
                              ? Read<Header>(first->Content)
                              : std::nullopt;
            contents.Header = header ? std::move(*header) : Header{};
            contents.IsIndexed = true;
            contents.GoodUntil = source.Size();
            return contents;
        }
    }
    return ScanContents(source, limits);
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

namespace
{

// The log times of the channel's messages in the chunk.
std::vector<std::uint64_t> TimesIn(ByteSource &source, const ChunkIndex &chunk, std::uint16_t channel)
{
    const auto found = chunk.MessageIndexOffsets.find(channel);
    const auto head =
        found == chunk.MessageIndexOffsets.end() ? std::nullopt : ReadPart(source, found->second, RecordHead);
    const std::uint64_t length =
        head ? ReadHead(std::span<const std::uint8_t, RecordHead>(head->data(), RecordHead)).Length : 0;
    const auto bytes = head && length <= chunk.MessageIndexLength
                           ? ReadPart(source, found->second + RecordHead, length)
                           : std::nullopt;
    const auto index = bytes ? Read<MessageIndex>(*bytes) : std::nullopt;
    std::vector<std::uint64_t> times;
    if (index && index->ChannelId == channel)
    {
        for (const auto &[time, offset] : index->Entries)
        {
            times.push_back(time);
        }
    }
    return times;
}

// The log times of the first and the last message of the channel.
std::optional<std::pair<std::uint64_t, std::uint64_t>> SpanOf(ByteSource &source, const Contents &contents,
                                                              std::uint16_t channel)
{
    if (const auto known = contents.Spans.find(channel); known != contents.Spans.end())
    {
        return known->second;
    }
    std::optional<std::pair<std::uint64_t, std::uint64_t>> span;
    const auto take = [&](const ChunkIndex &chunk)
    {
        // Chunks follow each other in time, as a rule: most are passed over.
        if (span && chunk.StartTime >= span->first && chunk.EndTime <= span->second)
        {
            return;
        }
        for (const std::uint64_t time : TimesIn(source, chunk, channel))
        {
            span = span ? std::pair(std::min(span->first, time), std::max(span->second, time))
                        : std::pair(time, time);
        }
    };
    // From both ends inwards.
    const std::vector<ChunkIndex> &chunks = contents.Chunks;
    for (std::size_t i = 0; i < (chunks.size() + 1) / 2; ++i)
    {
        take(chunks[i]);
        take(chunks[chunks.size() - 1 - i]);
    }
    return span;
}

}  // namespace

std::optional<double> RateOf(ByteSource &source, const Contents &contents, std::uint16_t channel)
{
    constexpr std::uint64_t least = 3;
    const auto &counts = contents.Statistics.ChannelMessageCounts;
    const auto count = counts.find(channel);
    const auto span =
        count == counts.end() || count->second < least ? std::nullopt : SpanOf(source, contents, channel);
    if (!span || span->second <= span->first)
    {
        return std::nullopt;
    }
    return 1e9 * static_cast<double>(count->second - 1) / static_cast<double>(span->second - span->first);
}

bool IsRecording(ByteSource &source)
{
    std::array<std::uint8_t, Magic.size()> begin{};
    return source.Size() >= begin.size() && source.Read(0, begin) && begin == Magic;
}

}  // namespace Rabit::Mcap
