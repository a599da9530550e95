#pragma once

#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapRecords.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Backfill
{

// Where the messages of chosen channels are in the recordings of one node in a folder. Each file is read
// once, as it grows, and only the heads of its records. Not thread-safe.
class RecordingIndex
{
public:
    // Files that were last written to before that are not read: no post is requested that is older than 24 h
    // (GatewayConfig: `backfill_last`). The rest is for clocks that were adjusted.
    static constexpr std::chrono::hours LongestKept{25};
    // Chunks that are kept in memory: successive questions are about the same ones.
    static constexpr std::size_t MostOpenChunks = 4;

    using Wants = std::function<bool(const Mcap::Channel &channel)>;
    RecordingIndex(std::string folder, std::string node, Wants wants)
        : _folder(std::move(folder)), _node(std::move(node)), _wants(std::move(wants))
    {
    }

    // The messages of one channel in one chunk.
    struct Piece
    {
        std::uint64_t Offset = 0;  // of the chunk in the file
        std::uint64_t Length = 0;
        std::uint16_t Channel = 0;
        std::uint64_t FirstLog = 0;  // log times
        std::uint64_t LastLog = 0;
        // The chunk is damaged and has no indexes: it may have messages of each channel.
        bool IsOfAnyChannel = false;
    };
    struct File
    {
        std::string Path;
        std::uint64_t Number = 0;  // in its name
        std::uint64_t ReadUntil = 0;
        bool IsOver = false;                              // nothing more will come
        bool IsOwn = false;                               // of this node
        std::map<std::uint16_t, Mcap::Channel> Channels;  // that are wanted
        std::set<std::uint16_t> OtherChannels;            // that are not
        std::map<std::string, Mcap::TextMap> Metadata;    // the last of each name
        // Of wanted channels, and of those that are in neither set, since the chunk that describes them is
        // damaged.
        std::vector<Piece> Pieces;
        // Of all channels: the file has all messages up to this one. A file that grows has chunks of small
        // and of large messages in turns, and perhaps not yet the other one of the last two.
        std::uint64_t NewestLog = 0;
        std::uint64_t LastChunkEnd = 0;  // log time
    };

    // Looks for new files, and reads what has come. Files that are gone, and old ones, are forgotten. The
    // last chunk of the newest file is left for later, since its indexes may still be being written, unless
    // `isOver`. False: the folder or a file cannot be read now, so something may be missing in Files. A file
    // that was removed, or that this user may not read, is not missing.
    bool Refresh(bool isOver = false);
    // By their names, the oldest first; only those of this node count.
    const std::map<std::string, File> &Files() const { return _files; }
    enum class Access
    {
        Done,
        Damaged,  // the chunk can never be read
        Failed    // the file cannot be opened or read now, as if it was removed
    };
    // Calls `visit` with each message of that piece.
    Access Visit(const File &file, const Piece &piece,
                 const std::function<void(const Mcap::Message &message)> &visit);

private:
    struct OpenChunk
    {
        std::string Path;
        std::uint64_t Offset = 0;
        Mcap::Bytes Records;
    };

    // A chunk, and the indexes that stand behind it.
    struct Chunk
    {
        std::uint64_t Offset = 0;
        std::uint64_t Length = 0;    // 0: none
        std::uint64_t FirstLog = 0;  // log times
        std::uint64_t LastLog = 0;
        std::vector<Mcap::MessageIndex> Indexes;
        bool IsIndexed = true;  // no index is damaged or may be missing
    };

    // These return false if the file cannot be read now. Chunks that were taken before stay.
    bool ReadOn(File &file, bool mayGrow);
    bool TakeChunk(File &file, Chunk &chunk, std::uint64_t end);
    Access ReadChunk(File &file, Chunk &chunk);
    void LearnFromSummary(File &file);
    void Learn(File &file, const Mcap::Channel &channel) const;
    // Null if it cannot be read, with the reason. Valid until the next call.
    const Mcap::Bytes *Open(const std::string &path, std::uint64_t offset, std::uint64_t length,
                            Access &access);

    const std::string _folder;
    const std::string _node;
    const Wants _wants;
    std::map<std::string, File> _files;
    std::deque<OpenChunk> _open;
};

}  // namespace Rabit::Backfill
