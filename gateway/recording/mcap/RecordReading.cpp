#include "recording/mcap/Crc32.h"
#include "recording/mcap/FieldReader.h"
#include "recording/mcap/RecordCodec.h"

namespace Rabit::Mcap
{
namespace
{

template <typename T>
std::optional<T> If(const FieldReader &in, T &&record)
{
    return in.IsGood() ? std::optional<T>(std::forward<T>(record)) : std::nullopt;
}

}  // namespace

Head ReadHead(std::span<const std::uint8_t, RecordHead> bytes)
{
    FieldReader in(bytes);
    Head head;
    head.Code = in.Number<std::uint8_t>();
    head.Length = in.Number<std::uint64_t>();
    return head;
}

std::optional<Header> ReadHeader(ByteView content)
{
    FieldReader in(content);
    Header record;
    record.Profile = in.Text();
    record.Library = in.Text();
    return If(in, std::move(record));
}

std::optional<Footer> ReadFooter(ByteView content)
{
    FieldReader in(content);
    Footer record;
    record.SummaryStart = in.Number<std::uint64_t>();
    record.SummaryOffsetStart = in.Number<std::uint64_t>();
    record.SummaryCrc = in.Number<std::uint32_t>();
    return If(in, std::move(record));
}

std::optional<Schema> ReadSchema(ByteView content)
{
    FieldReader in(content);
    Schema record;
    record.Id = in.Number<std::uint16_t>();
    record.Name = in.Text();
    record.Encoding = in.Text();
    record.Data = in.Text();
    return record.Id == 0 ? std::nullopt : If(in, std::move(record));
}

std::optional<Channel> ReadChannel(ByteView content)
{
    FieldReader in(content);
    Channel record;
    record.Id = in.Number<std::uint16_t>();
    record.SchemaId = in.Number<std::uint16_t>();
    record.Topic = in.Text();
    record.MessageEncoding = in.Text();
    record.Metadata = in.Texts();
    return If(in, std::move(record));
}

std::optional<Message> ReadMessage(ByteView content)
{
    FieldReader in(content);
    Message record;
    record.ChannelId = in.Number<std::uint16_t>();
    record.Sequence = in.Number<std::uint32_t>();
    record.LogTime = in.Number<std::uint64_t>();
    record.PublishTime = in.Number<std::uint64_t>();
    record.Data = in.Rest();
    return If(in, std::move(record));
}

std::optional<Chunk> ReadChunk(ByteView content)
{
    FieldReader in(content);
    Chunk record;
    record.StartTime = in.Number<std::uint64_t>();
    record.EndTime = in.Number<std::uint64_t>();
    record.UncompressedSize = in.Number<std::uint64_t>();
    record.UncompressedCrc = in.Number<std::uint32_t>();
    record.Compression = in.Text();
    record.Records = in.Raw(in.Number<std::uint64_t>());
    return If(in, std::move(record));
}

std::optional<MessageIndex> ReadMessageIndex(ByteView content)
{
    FieldReader in(content);
    MessageIndex record;
    record.ChannelId = in.Number<std::uint16_t>();
    in.NumberPairs<std::uint64_t, std::uint64_t>([&record](std::uint64_t time, std::uint64_t offset)
                                                 { record.Entries.emplace_back(time, offset); });
    return If(in, std::move(record));
}

std::optional<ChunkIndex> ReadChunkIndex(ByteView content)
{
    FieldReader in(content);
    ChunkIndex record;
    record.StartTime = in.Number<std::uint64_t>();
    record.EndTime = in.Number<std::uint64_t>();
    record.Offset = in.Number<std::uint64_t>();
    record.Length = in.Number<std::uint64_t>();
    in.NumberPairs<std::uint16_t, std::uint64_t>([&record](std::uint16_t channel, std::uint64_t offset)
                                                 { record.MessageIndexOffsets[channel] = offset; });
    record.MessageIndexLength = in.Number<std::uint64_t>();
    record.Compression = in.Text();
    record.CompressedSize = in.Number<std::uint64_t>();
    record.UncompressedSize = in.Number<std::uint64_t>();
    return If(in, std::move(record));
}

std::optional<Attachment> ReadAttachment(ByteView content)
{
    FieldReader in(content);
    Attachment record;
    record.LogTime = in.Number<std::uint64_t>();
    record.CreateTime = in.Number<std::uint64_t>();
    record.Name = in.Text();
    record.MediaType = in.Text();
    record.Data = in.Raw(in.Number<std::uint64_t>());
    const auto crc = in.Number<std::uint32_t>();
    if (!in.IsGood())
    {
        return std::nullopt;
    }
    const auto covered = static_cast<std::size_t>(record.Data.data() + record.Data.size() - content.data());
    if (crc != 0 && crc != Crc32(content.first(covered)))
    {
        return std::nullopt;
    }
    return record;
}

std::optional<AttachmentIndex> ReadAttachmentIndex(ByteView content)
{
    FieldReader in(content);
    AttachmentIndex record;
    record.Offset = in.Number<std::uint64_t>();
    record.Length = in.Number<std::uint64_t>();
    record.LogTime = in.Number<std::uint64_t>();
    record.CreateTime = in.Number<std::uint64_t>();
    record.DataSize = in.Number<std::uint64_t>();
    record.Name = in.Text();
    record.MediaType = in.Text();
    return If(in, std::move(record));
}

std::optional<Statistics> ReadStatistics(ByteView content)
{
    FieldReader in(content);
    Statistics record;
    record.MessageCount = in.Number<std::uint64_t>();
    record.SchemaCount = in.Number<std::uint16_t>();
    record.ChannelCount = in.Number<std::uint32_t>();
    record.AttachmentCount = in.Number<std::uint32_t>();
    record.MetadataCount = in.Number<std::uint32_t>();
    record.ChunkCount = in.Number<std::uint32_t>();
    record.StartTime = in.Number<std::uint64_t>();
    record.EndTime = in.Number<std::uint64_t>();
    in.NumberPairs<std::uint16_t, std::uint64_t>([&record](std::uint16_t channel, std::uint64_t count)
                                                 { record.ChannelMessageCounts[channel] = count; });
    return If(in, std::move(record));
}

std::optional<Metadata> ReadMetadata(ByteView content)
{
    FieldReader in(content);
    Metadata record;
    record.Name = in.Text();
    record.Values = in.Texts();
    return If(in, std::move(record));
}

std::optional<MetadataIndex> ReadMetadataIndex(ByteView content)
{
    FieldReader in(content);
    MetadataIndex record;
    record.Offset = in.Number<std::uint64_t>();
    record.Length = in.Number<std::uint64_t>();
    record.Name = in.Text();
    return If(in, std::move(record));
}

std::optional<SummaryOffset> ReadSummaryOffset(ByteView content)
{
    FieldReader in(content);
    SummaryOffset record;
    record.Group = static_cast<Opcode>(in.Number<std::uint8_t>());
    record.Start = in.Number<std::uint64_t>();
    record.Length = in.Number<std::uint64_t>();
    return If(in, std::move(record));
}

}  // namespace Rabit::Mcap
