#pragma once

#include <rabit/mcap/McapRecords.h>

#include <optional>

// These functions keep no state, so any thread may call them. Append functions encode a record with its head.
// Read functions decode a record from the bytes behind its head. They return nothing for bytes that are no
// such record, and never read past them. They take no more memory than a small multiple of the number of
// bytes. Bytes behind the fields that are known here are ignored, as the format requires. Views in a decoded
// record point into the bytes.
namespace Rabit::Mcap
{

// Record: Header, Footer and so on, but no Chunk. An attachment is written with its CRC.
template <typename Record>
void Append(Bytes &to, const Record &record);
void AppendDataEnd(Bytes &to);
// Appends all of a chunk but its records (chunk.Records), which the caller must write next.
void AppendChunkHead(Bytes &to, const Chunk &chunk);
// Appends a footer, with a SummaryCrc over `summary` and the bytes of the footer before it.
void AppendFooter(Bytes &to, Footer footer, ByteView summary);

// Nothing, too, for an attachment whose CRC is wrong.
template <typename Record>
std::optional<Record> Read(ByteView content);

// The head of a record: 9 bytes.
struct Head
{
    std::uint8_t Code = 0;
    std::uint64_t Length = 0;
};
Head ReadHead(std::span<const std::uint8_t, RecordHead> bytes);

}  // namespace Rabit::Mcap
