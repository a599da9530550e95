#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

// The records of an MCAP file, as https://mcap.dev/spec has them: plain values. Times are nanoseconds since
// 1970 (UTC), sizes and offsets are bytes. A ByteView points into bytes that somebody else owns: the function
// that returns it says how long it is valid.
namespace Rabit::Mcap
{

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;
using TextMap = std::map<std::string, std::string>;
// Bytes that an entry takes in memory besides its texts, about: the node of the map.
inline constexpr std::size_t TextEntrySize = 128;

// At the beginning and at the end of a file.
inline constexpr std::array<std::uint8_t, 8> Magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
// Bytes of the head of each record: opcode, and length of the content.
inline constexpr std::size_t RecordHead = 9;

enum class Opcode : std::uint8_t
{
    Header = 0x01,
    Footer = 0x02,
    Schema = 0x03,
    Channel = 0x04,
    Message = 0x05,
    Chunk = 0x06,
    MessageIndex = 0x07,
    ChunkIndex = 0x08,
    Attachment = 0x09,
    AttachmentIndex = 0x0A,
    Statistics = 0x0B,
    Metadata = 0x0C,
    MetadataIndex = 0x0D,
    SummaryOffset = 0x0E,
    DataEnd = 0x0F
};

struct Header
{
    static constexpr Opcode Code = Opcode::Header;
    std::string Profile;
    std::string Library;
};

struct Footer
{
    static constexpr Opcode Code = Opcode::Footer;
    std::uint64_t SummaryStart = 0;  // 0: there is none
    std::uint64_t SummaryOffsetStart = 0;
    std::uint32_t SummaryCrc = 0;  // 0: not known
};

struct Schema
{
    static constexpr Opcode Code = Opcode::Schema;
    std::uint16_t Id = 0;  // from 1
    std::string Name;
    std::string Encoding;
    std::string Data;
};

struct Channel
{
    static constexpr Opcode Code = Opcode::Channel;
    std::uint16_t Id = 0;
    std::uint16_t SchemaId = 0;  // 0: none
    std::string Topic;
    std::string MessageEncoding;
    TextMap Metadata;
};

struct Message
{
    static constexpr Opcode Code = Opcode::Message;
    std::uint16_t ChannelId = 0;
    std::uint32_t Sequence = 0;     // 0: not numbered
    std::uint64_t LogTime = 0;      // when it was recorded
    std::uint64_t PublishTime = 0;  // when it was posted or sent
    ByteView Data;
};

struct Chunk
{
    static constexpr Opcode Code = Opcode::Chunk;
    std::uint64_t StartTime = 0;  // the least log time in it; 0 if it is empty
    std::uint64_t EndTime = 0;
    std::uint64_t UncompressedSize = 0;
    std::uint32_t UncompressedCrc = 0;  // 0: not known
    std::string Compression;            // empty, `zstd` or `lz4`
    ByteView Records;                   // as they are in the file
};

struct MessageIndex
{
    static constexpr Opcode Code = Opcode::MessageIndex;
    std::uint16_t ChannelId = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> Entries;  // log time, offset in the chunk's records
};

struct ChunkIndex
{
    static constexpr Opcode Code = Opcode::ChunkIndex;
    std::uint64_t StartTime = 0;
    std::uint64_t EndTime = 0;
    std::uint64_t Offset = 0;                                    // of the chunk's record in the file
    std::uint64_t Length = 0;                                    // its head included
    std::map<std::uint16_t, std::uint64_t> MessageIndexOffsets;  // by channel
    std::uint64_t MessageIndexLength = 0;
    std::string Compression;
    std::uint64_t CompressedSize = 0;
    std::uint64_t UncompressedSize = 0;
};

struct Attachment
{
    static constexpr Opcode Code = Opcode::Attachment;
    std::uint64_t LogTime = 0;
    std::uint64_t CreateTime = 0;
    std::string Name;
    std::string MediaType;
    ByteView Data;
};

struct AttachmentIndex
{
    static constexpr Opcode Code = Opcode::AttachmentIndex;
    std::uint64_t Offset = 0;
    std::uint64_t Length = 0;
    std::uint64_t LogTime = 0;
    std::uint64_t CreateTime = 0;
    std::uint64_t DataSize = 0;
    std::string Name;
    std::string MediaType;
};

struct Statistics
{
    static constexpr Opcode Code = Opcode::Statistics;
    std::uint64_t MessageCount = 0;
    std::uint16_t SchemaCount = 0;
    std::uint32_t ChannelCount = 0;
    std::uint32_t AttachmentCount = 0;
    std::uint32_t MetadataCount = 0;
    std::uint32_t ChunkCount = 0;
    std::uint64_t StartTime = 0;  // 0 if there are no messages
    std::uint64_t EndTime = 0;
    std::map<std::uint16_t, std::uint64_t> ChannelMessageCounts;
};

struct Metadata
{
    static constexpr Opcode Code = Opcode::Metadata;
    std::string Name;
    TextMap Values;
};

struct MetadataIndex
{
    static constexpr Opcode Code = Opcode::MetadataIndex;
    std::uint64_t Offset = 0;
    std::uint64_t Length = 0;
    std::string Name;
};

struct SummaryOffset
{
    static constexpr Opcode Code = Opcode::SummaryOffset;
    Opcode Group = Opcode::Schema;
    std::uint64_t Start = 0;
    std::uint64_t Length = 0;
};

}  // namespace Rabit::Mcap
