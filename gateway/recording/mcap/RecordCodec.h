#pragma once

#include <optional>

#include "recording/mcap/McapRecords.h"

// Append functions encode a record with its head. Read functions decode a record from the bytes behind its
// head. They return nothing for bytes that are no such record, never read past them, and take no more
// memory than a small multiple of their number. Bytes behind the fields that are known here are ignored, as
// the format requires. Views in a decoded record point into the bytes.
namespace Rabit::Mcap
{

void Append(Bytes &to, const Header &record);
void Append(Bytes &to, const Footer &record);
void Append(Bytes &to, const Schema &record);
void Append(Bytes &to, const Channel &record);
void Append(Bytes &to, const Message &record);
void Append(Bytes &to, const MessageIndex &record);
void Append(Bytes &to, const ChunkIndex &record);
void Append(Bytes &to, const Attachment &record);  // with its CRC
void Append(Bytes &to, const AttachmentIndex &record);
void Append(Bytes &to, const Statistics &record);
void Append(Bytes &to, const Metadata &record);
void Append(Bytes &to, const MetadataIndex &record);
void Append(Bytes &to, const SummaryOffset &record);
void AppendDataEnd(Bytes &to);
// Appends all of a chunk but its records (chunk.Records), which the caller must write next.
void AppendChunkHead(Bytes &to, const Chunk &chunk);
// Appends a footer, with a SummaryCrc over `summary` and the bytes of the footer before it.
void AppendFooter(Bytes &to, Footer footer, ByteView summary);

std::optional<Header> ReadHeader(ByteView content);
std::optional<Footer> ReadFooter(ByteView content);
std::optional<Schema> ReadSchema(ByteView content);
std::optional<Channel> ReadChannel(ByteView content);
std::optional<Message> ReadMessage(ByteView content);
std::optional<Chunk> ReadChunk(ByteView content);
std::optional<MessageIndex> ReadMessageIndex(ByteView content);
std::optional<ChunkIndex> ReadChunkIndex(ByteView content);
std::optional<Attachment> ReadAttachment(ByteView content);  // nothing, too, if its CRC is wrong
std::optional<AttachmentIndex> ReadAttachmentIndex(ByteView content);
std::optional<Statistics> ReadStatistics(ByteView content);
std::optional<Metadata> ReadMetadata(ByteView content);
std::optional<MetadataIndex> ReadMetadataIndex(ByteView content);
std::optional<SummaryOffset> ReadSummaryOffset(ByteView content);

// The head of a record: 9 bytes.
struct Head
{
    std::uint8_t Code = 0;
    std::uint64_t Length = 0;
};
Head ReadHead(std::span<const std::uint8_t, RecordHead> bytes);

}  // namespace Rabit::Mcap
