#include "recording/mcap/Crc32.h"
#include "recording/mcap/FieldWriter.h"
#include "recording/mcap/RecordCodec.h"

namespace Rabit::Mcap
{

void Append(Bytes &to, const Header &record)
{
    FieldWriter out(to, Opcode::Header);
    out.Text(record.Profile);
    out.Text(record.Library);
}

void Append(Bytes &to, const Footer &record)
{
    FieldWriter out(to, Opcode::Footer);
    out.Number(record.SummaryStart);
    out.Number(record.SummaryOffsetStart);
    out.Number(record.SummaryCrc);
}

void AppendFooter(Bytes &to, Footer footer, ByteView summary)
{
    Bytes bytes;
    Append(bytes, footer);
    const ByteView before = ByteView(bytes).first(bytes.size() - sizeof footer.SummaryCrc);
    footer.SummaryCrc = Crc32(before, Crc32(summary));
    Append(to, footer);
}

void Append(Bytes &to, const Schema &record)
{
    FieldWriter out(to, Opcode::Schema);
    out.Number(record.Id);
    out.Text(record.Name);
    out.Text(record.Encoding);
    out.Text(record.Data);
}

void Append(Bytes &to, const Channel &record)
{
    FieldWriter out(to, Opcode::Channel);
    out.Number(record.Id);
    out.Number(record.SchemaId);
    out.Text(record.Topic);
    out.Text(record.MessageEncoding);
    out.Texts(record.Metadata);
}

void Append(Bytes &to, const Message &record)
{
    FieldWriter out(to, Opcode::Message);
    out.Number(record.ChannelId);
    out.Number(record.Sequence);
    out.Number(record.LogTime);
    out.Number(record.PublishTime);
    out.Raw(record.Data);
}

void AppendChunkHead(Bytes &to, const Chunk &chunk)
{
    FieldWriter out(to, Opcode::Chunk);
    out.Number(chunk.StartTime);
    out.Number(chunk.EndTime);
    out.Number(chunk.UncompressedSize);
    out.Number(chunk.UncompressedCrc);
    out.Text(chunk.Compression);
    out.Number(static_cast<std::uint64_t>(chunk.Records.size()));
    out.Beyond(chunk.Records.size());
}

void Append(Bytes &to, const MessageIndex &record)
{
    FieldWriter out(to, Opcode::MessageIndex);
    out.Number(record.ChannelId);
    out.NumberPairs(record.Entries);
}

void Append(Bytes &to, const ChunkIndex &record)
{
    FieldWriter out(to, Opcode::ChunkIndex);
    out.Number(record.StartTime);
    out.Number(record.EndTime);
    out.Number(record.Offset);
    out.Number(record.Length);
    out.NumberPairs(record.MessageIndexOffsets);
    out.Number(record.MessageIndexLength);
    out.Text(record.Compression);
    out.Number(record.CompressedSize);
    out.Number(record.UncompressedSize);
}

void Append(Bytes &to, const Attachment &record)
{
    FieldWriter out(to, Opcode::Attachment);
    out.Number(record.LogTime);
    out.Number(record.CreateTime);
    out.Text(record.Name);
    out.Text(record.MediaType);
    out.Number(static_cast<std::uint64_t>(record.Data.size()));
    out.Raw(record.Data);
    out.Number(Crc32(out.Content()));
}

void Append(Bytes &to, const AttachmentIndex &record)
{
    FieldWriter out(to, Opcode::AttachmentIndex);
    out.Number(record.Offset);
    out.Number(record.Length);
    out.Number(record.LogTime);
    out.Number(record.CreateTime);
    out.Number(record.DataSize);
    out.Text(record.Name);
    out.Text(record.MediaType);
}

void Append(Bytes &to, const Statistics &record)
{
    FieldWriter out(to, Opcode::Statistics);
    out.Number(record.MessageCount);
    out.Number(record.SchemaCount);
    out.Number(record.ChannelCount);
    out.Number(record.AttachmentCount);
    out.Number(record.MetadataCount);
    out.Number(record.ChunkCount);
    out.Number(record.StartTime);
    out.Number(record.EndTime);
    out.NumberPairs(record.ChannelMessageCounts);
}

void Append(Bytes &to, const Metadata &record)
{
    FieldWriter out(to, Opcode::Metadata);
    out.Text(record.Name);
    out.Texts(record.Values);
}

void Append(Bytes &to, const MetadataIndex &record)
{
    FieldWriter out(to, Opcode::MetadataIndex);
    out.Number(record.Offset);
    out.Number(record.Length);
    out.Text(record.Name);
}

void Append(Bytes &to, const SummaryOffset &record)
{
    FieldWriter out(to, Opcode::SummaryOffset);
    out.Number(static_cast<std::uint8_t>(record.Group));
    out.Number(record.Start);
    out.Number(record.Length);
}

void AppendDataEnd(Bytes &to)
{
    FieldWriter out(to, Opcode::DataEnd);
    out.Number(std::uint32_t{0});  // the CRC of all data: each chunk has its own
}

}  // namespace Rabit::Mcap
