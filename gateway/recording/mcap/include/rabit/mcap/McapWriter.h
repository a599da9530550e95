#pragma once

#include <rabit/mcap/ByteSink.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Mcap
{

class ChunkBuilder;

// Writes one MCAP file. The constructor writes the beginning. A chunk is written when it is full, or by
// FinishChunks. Finish writes the summary, by which readers find messages without reading all.
//
// A truncated file can be read up to the last whole record: a schema and a channel stand in the chunks
// before their first message. Messages are compressed with zstd, except large ones, pictures as a rule.
// These have chunks of their own: compressing them would cost time in vain, and other messages would wait
// for a chunk to fill with them.
//
// After the sink has failed nothing is written any more, and IsGood is false. Not thread-safe.
class McapWriter
{
public:
    static constexpr std::size_t ChunkSize = 1U << 20;
    // A message of this size or more is large.
    static constexpr std::size_t LargeMessage = 16U << 10;
    static constexpr std::size_t LargeChunkSize = 4U << 20;
    // Larger messages are refused: readers have their bounds, too.
    static constexpr std::size_t LargestMessage = 128U << 20;

    struct Options
    {
        std::string Library;
        std::string Profile;
        bool Compresses = true;
    };
    // The sink must outlive the writer.
    McapWriter(ByteSink &sink, const Options &options);
    ~McapWriter();
    McapWriter(const McapWriter &) = delete;
    McapWriter &operator=(const McapWriter &) = delete;

    // Return the number of the new schema or channel. At most 65535 of each: beyond that AddSchema returns
    // 0, which means none, and AddChannel nothing. A schema that the writer does not have throws
    // std::invalid_argument.
    std::uint16_t AddSchema(const std::string &name, const std::string &encoding, const std::string &data);
    std::optional<std::uint16_t> AddChannel(std::uint16_t schema, const std::string &topic,
                                            const std::string &encoding, const TextMap &metadata = {});
    // Adds a message; false if it is larger than LargestMessage, or the sink has failed. A channel that the
    // writer does not have throws std::invalid_argument.
    bool Add(const Message &message);
    bool AddMetadata(const Metadata &metadata);
    bool AddAttachment(const Attachment &attachment);
    // Writes the unfinished chunks.
    bool FinishChunks();
    // Writes the unfinished chunks and the summary. Nothing may be added after it.
    bool Finish();

    bool IsGood() const { return _good; }
    // Bytes that the sink took; and the same with the bytes that wait in chunks.
    std::uint64_t BytesWritten() const { return _offset; }
    std::uint64_t BytesToWrite() const;
    const Statistics &Counted() const { return _statistics; }

private:
    // The kinds of chunks into which a schema or channel has been written.
    struct Places
    {
        bool Small = false;
        bool Large = false;
    };
    struct KnownChannel
    {
        Channel Record;
        Places In;
    };
    struct KnownSchema
    {
        Schema Record;
        Places In;
    };

    bool Write(ByteView bytes);
    bool FinishChunk(ChunkBuilder &chunk);
    void Introduce(KnownChannel &channel, ChunkBuilder &chunk, bool Places::*place);
    void AppendSummary(Bytes &to, std::vector<SummaryOffset> &groups) const;

    ByteSink &_sink;
    const std::unique_ptr<ChunkBuilder> _small;
    const std::unique_ptr<ChunkBuilder> _large;
    std::vector<KnownSchema> _schemas;    // number 1 first
    std::vector<KnownChannel> _channels;  // number 0 first
    std::vector<std::uint64_t> _counts;   // by channel
    Bytes _chunkIndexes;
    Bytes _attachmentIndexes;
    Bytes _metadataIndexes;
    Statistics _statistics;
    std::uint64_t _offset = 0;
    bool _good = true;
};

}  // namespace Rabit::Mcap
