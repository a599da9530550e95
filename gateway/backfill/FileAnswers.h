#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backfill.idl.h"
#include "backfill/FileHash.h"

namespace Rabit::Backfill
{

// Answers questions about the files of one folder. Only regular files in it are sent: a name with a slash, a
// symbolic link, a device and a folder are UNKNOWN, as is a file that is not there. A file that cannot be
// opened FAILED. Not thread-safe.
class FileAnswers
{
public:
    // Bytes in one answer.
    static constexpr std::uint64_t LargestPart = 64U << 10;
    // Bytes that are hashed in one turn, of all files together, so that large files hold up nobody: a tenth
    // of a second of a slow processor.
    static constexpr std::uint64_t HashedAtOnce = 16U << 20;

    using MayFetch = std::function<bool(const std::string &node)>;
    // Without a folder nothing is allowed.
    FileAnswers(std::string folder, MayFetch mayFetch)
        : _folder(std::move(folder)), _mayFetch(std::move(mayFetch))
    {
    }

    // Begins a turn: HashedAtOnce bytes may be hashed until the next one.
    void BeginTurn() { _mayHash = HashedAtOnce; }

    // The question must be of the kind FACTS or PART. Empty: the file is being hashed, or others are; ask
    // again in the next turn.
    std::optional<Answer> Of(const std::string &node, const Question &question);

private:
    struct Facts
    {
        std::uint64_t Size = 0;
        std::int64_t ChangedAt = 0;
        dev_t Device = 0;
        ino_t Inode = 0;
        std::vector<std::uint8_t> Hash;
        std::unique_ptr<FileHash> Work;  // until the hash is there
    };
    // Hashes that are remembered or under way: a large file takes seconds.
    static constexpr std::size_t MostFacts = 64;

    // Returns false while the file is being hashed.
    bool AnswerFacts(int file, const Question &question, Answer &answer);

    const std::string _folder;
    const MayFetch _mayFetch;
    std::map<std::string, Facts> _facts;
    std::uint64_t _mayHash = HashedAtOnce;  // in this turn
};

}  // namespace Rabit::Backfill
