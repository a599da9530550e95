#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/mcap/ByteSink.h"
#include "recording/mcap/ChunkBuilder.h"

namespace Rabit::Mcap
{

// Writes one MCAP file: the beginning when it is made, chunks as they are full or FinishChunks is called, and
// with Finish the summary that readers need to find anything without reading all.
//
// A file that ends anywhere can be read up to the last whole record: schema and channel stand in the chunks
// before the first message of each. Messages are compressed with zstd, but for large ones, pictures as a
// rule, which have chunks of their own as they are: neither do they cost time in vain, nor do the others wait
// for a chunk to be full of them.
//
// After the sink has failed nothing is written any more, and IsGood is false. Not thread-safe.
class McapWriter
{
public:
    static constexpr std::size_t ChunkSize = 1U << 20;
    // From here on a message is large.
    static constexpr std::size_t LargeMessage = 16U << 10;
    static constexpr std::size_t LargeChunkSize = 4U << 20;
    // What is larger is refused: readers have their bounds, too.
    static constexpr std::size_t LargestMessage = 128U << 20;

    struct Options
    {
        std::string Library;
        std::string Profile;
        bool Compresses = true;
    };
    // The sink must outlive it.
    McapWriter(ByteSink &sink, const Options &options);

    // Return the number by which it is named. No more than 65535 of each: then 0 for a schema, which is
    // none, and nothing for a channel. A schema that the writer does not have throws std::invalid_argument.
    std::uint16_t AddSchema(const std::string &name, const std::string &encoding, const std::string &data);
    std::optional<std::uint16_t> AddChannel(std::uint16_t schema, const std::string &topic,
                                            const std::string &encoding, const TextMap &metadata = {});
    // False if it is larger than LargestMessage, or the sink has failed. A channel that the writer does not
    // have throws std::invalid_argument.
    bool Add(const Message &message);
    bool AddMetadata(const Metadata &metadata);
    bool AddAttachment(const Attachment &attachment);
    // Writes what is in unfinished chunks.
    bool FinishChunks();
    // What is in unfinished chunks and the summary. Nothing may be added after it.
    bool Finish();

    bool IsGood() const { return _good; }
    // What the sink took, and with it what waits in chunks.
    std::uint64_t BytesWritten() const { return _offset; }
    std::uint64_t BytesToWrite() const { return _offset + _small.Size() + _large.Size(); }
    const Statistics &Counted() const { return _statistics; }

private:
    // Where a schema or channel has been written to.
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
    ChunkBuilder _small;
    ChunkBuilder _large{false};
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
