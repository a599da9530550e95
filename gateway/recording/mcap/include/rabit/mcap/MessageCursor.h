#pragma once

#include <rabit/mcap/McapContents.h>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <queue>

namespace Rabit::Mcap
{

// Returns the messages of a file in the order of log times; messages of one time in the order of the file.
// Loads chunks as it comes to them. No content of the file makes it throw: a chunk that cannot be read is
// left out, and is a problem. Not thread-safe.
class MessageCursor
{
public:
    struct Selection
    {
        std::uint64_t From = 0;
        std::uint64_t To = std::numeric_limits<std::uint64_t>::max();  // included
        std::function<bool(std::uint16_t channel)> Wants{};            // null: all
    };
    // Memory for chunks that overlap in time, which must be held together. Chunks beyond it are not read,
    // and are a problem.
    static constexpr std::size_t MostBytes = 1U << 30;

    // Both must outlive the cursor, and the file must not become shorter.
    MessageCursor(ByteSource &source, const Contents &contents, Selection selection);
    ~MessageCursor();
    // Returns the next message, valid until the next call; nothing at the end.
    std::optional<Message> Next();
    // The chunks that could not be read, one line each.
    const std::vector<std::string> &Problems() const { return _problems; }

private:
    struct Entry
    {
        std::uint64_t Time;
        std::size_t Offset;
    };
    struct Loaded;
    struct Later
    {
        bool operator()(const std::shared_ptr<Loaded> &left, const std::shared_ptr<Loaded> &right) const;
    };

    void Load(const ChunkIndex &index);
    std::string LoadInto(const ChunkIndex &index, Loaded &loaded);

    ByteSource &_source;
    const Selection _selection;
    std::vector<const ChunkIndex *> _chunks;  // by their beginning
    std::size_t _next = 0;                    // of _chunks
    std::priority_queue<std::shared_ptr<Loaded>, std::vector<std::shared_ptr<Loaded>>, Later> _loaded;
    std::shared_ptr<Loaded> _current;  // holds the message that was returned last
    std::size_t _bytes = 0;
    std::vector<std::string> _problems;
};

}  // namespace Rabit::Mcap
