#include <rabit/mcap/RecordCodec.h>

#include <concepts>
#include <tuple>
#include <type_traits>

#include "recording/mcap/Crc32.h"
#include "recording/mcap/FieldReader.h"
#include "recording/mcap/FieldWriter.h"

namespace Rabit::Mcap
{
namespace
{

template <typename T, typename Record>
concept Is = std::same_as<std::remove_const_t<T>, Record>;

// The fields of each record, in the order of the format. A chunk and an attachment end with a part of their
// own.
struct Fields
{
    static auto Of(Is<Header> auto &r) { return std::tie(r.Profile, r.Library); }
    static auto Of(Is<Footer> auto &r)
    {
        return std::tie(r.SummaryStart, r.SummaryOffsetStart, r.SummaryCrc);
    }
    static auto Of(Is<Schema> auto &r) { return std::tie(r.Id, r.Name, r.Encoding, r.Data); }
    static auto Of(Is<Channel> auto &r)
    {
        return std::tie(r.Id, r.SchemaId, r.Topic, r.MessageEncoding, r.Metadata);
    }
    static auto Of(Is<Message> auto &r)
    {
        return std::tie(r.ChannelId, r.Sequence, r.LogTime, r.PublishTime, r.Data);
    }
    static auto Of(Is<Chunk> auto &r)
    {
        return std::tie(r.StartTime, r.EndTime, r.UncompressedSize, r.UncompressedCrc, r.Compression);
    }
    static auto Of(Is<MessageIndex> auto &r) { return std::tie(r.ChannelId, r.Entries); }
    static auto Of(Is<ChunkIndex> auto &r)
    {
        return std::tie(r.StartTime, r.EndTime, r.Offset, r.Length, r.MessageIndexOffsets,
                        r.MessageIndexLength, r.Compression, r.CompressedSize, r.UncompressedSize);
    }
    static auto Of(Is<Attachment> auto &r) { return std::tie(r.LogTime, r.CreateTime, r.Name, r.MediaType); }
    static auto Of(Is<AttachmentIndex> auto &r)
    {
        return std::tie(r.Offset, r.Length, r.LogTime, r.CreateTime, r.DataSize, r.Name, r.MediaType);
    }
    static auto Of(Is<Statistics> auto &r)
    {
        return std::tie(r.MessageCount, r.SchemaCount, r.ChannelCount, r.AttachmentCount, r.MetadataCount,
                        r.ChunkCount, r.StartTime, r.EndTime, r.ChannelMessageCounts);
    }
    static auto Of(Is<Metadata> auto &r) { return std::tie(r.Name, r.Values); }
    static auto Of(Is<MetadataIndex> auto &r) { return std::tie(r.Offset, r.Length, r.Name); }
    static auto Of(Is<SummaryOffset> auto &r) { return std::tie(r.Group, r.Start, r.Length); }
};

template <typename Record>
void AppendFields(FieldWriter &out, const Record &record)
{
    std::apply([&out](const auto &...fields) { (out.Put(fields), ...); }, Fields::Of(record));
}

template <typename Record>
void ReadFields(FieldReader &in, Record &record)
{
    std::apply([&in](auto &...fields) { (in.Get(fields), ...); }, Fields::Of(record));
}

}  // namespace

template <typename Record>
void Append(Bytes &to, const Record &record)
{
    FieldWriter out(to, Record::Code);
    AppendFields(out, record);
    if constexpr (std::is_same_v<Record, Attachment>)
    {
        out.Put(static_cast<std::uint64_t>(record.Data.size()));
        out.Put(record.Data);
        out.Put(Crc32(out.Content()));
    }
}

void AppendDataEnd(Bytes &to)
{
    FieldWriter out(to, Opcode::DataEnd);
    out.Put(std::uint32_t{0});  // the CRC of all data: each chunk has its own
}

void AppendChunkHead(Bytes &to, const Chunk &chunk)
{
    FieldWriter out(to, Opcode::Chunk);
    AppendFields(out, chunk);
    out.Put(static_cast<std::uint64_t>(chunk.Records.size()));
    out.Beyond(chunk.Records.size());
}

void AppendFooter(Bytes &to, Footer footer, ByteView summary)
{
    Bytes bytes;
    Append(bytes, footer);
    const ByteView before = ByteView(bytes).first(bytes.size() - sizeof footer.SummaryCrc);
    footer.SummaryCrc = Crc32(before, Crc32(summary));
    Append(to, footer);
}

template <typename Record>
std::optional<Record> Read(ByteView content)
{
    FieldReader in(content);
    Record record;
    ReadFields(in, record);
    bool isSound = true;
    if constexpr (std::is_same_v<Record, Schema>)
    {
        isSound = record.Id != 0;
    }
    if constexpr (std::is_same_v<Record, Chunk>)
    {
        record.Records = in.Raw(in.Number<std::uint64_t>());
    }
    if constexpr (std::is_same_v<Record, Attachment>)
    {
        record.Data = in.Raw(in.Number<std::uint64_t>());
        const std::size_t covered = content.size() - in.Left();
        const auto crc = in.Number<std::uint32_t>();
        isSound = in.IsGood() && (crc == 0 || crc == Crc32(content.first(covered)));
    }
    return isSound && in.IsGood() ? std::optional<Record>(std::move(record)) : std::nullopt;
}

Head ReadHead(std::span<const std::uint8_t, RecordHead> bytes)
{
    FieldReader in(bytes);
    Head head;
    in.Get(head.Code);
    in.Get(head.Length);
    return head;
}

template void Append(Bytes &, const Header &);
template void Append(Bytes &, const Footer &);
template void Append(Bytes &, const Schema &);
template void Append(Bytes &, const Channel &);
template void Append(Bytes &, const Message &);
template void Append(Bytes &, const MessageIndex &);
template void Append(Bytes &, const ChunkIndex &);
template void Append(Bytes &, const Attachment &);
template void Append(Bytes &, const AttachmentIndex &);
template void Append(Bytes &, const Statistics &);
template void Append(Bytes &, const Metadata &);
template void Append(Bytes &, const MetadataIndex &);
template void Append(Bytes &, const SummaryOffset &);
template std::optional<Header> Read(ByteView);
template std::optional<Footer> Read(ByteView);
template std::optional<Schema> Read(ByteView);
template std::optional<Channel> Read(ByteView);
template std::optional<Message> Read(ByteView);
template std::optional<Chunk> Read(ByteView);
template std::optional<MessageIndex> Read(ByteView);
template std::optional<ChunkIndex> Read(ByteView);
template std::optional<Attachment> Read(ByteView);
template std::optional<AttachmentIndex> Read(ByteView);
template std::optional<Statistics> Read(ByteView);
template std::optional<Metadata> Read(ByteView);
template std::optional<MetadataIndex> Read(ByteView);
template std::optional<SummaryOffset> Read(ByteView);

}  // namespace Rabit::Mcap
