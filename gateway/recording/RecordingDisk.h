#pragma once

#include <rabit/mcap/ByteSink.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

// The folder that recordings are written to. Not thread-safe.
class RecordingDisk
{
public:
    virtual ~RecordingDisk() = default;

    class File : public Mcap::ByteSink
    {
    public:
        // Returns when all written bytes would survive a power loss; false if that fails.
        virtual bool Sync() = 0;
    };
    struct Entry
    {
        std::string Name;
        std::uint64_t Bytes = 0;
    };

    // Creates a file. Returns null, with a reason, if the name is taken or the file cannot be made.
    virtual std::unique_ptr<File> Create(const std::string &name, std::string &reason) = 0;
    // Returns all files, in any order.
    virtual std::vector<Entry> List() = 0;
    virtual bool Remove(const std::string &name) = 0;
    // Returns how many bytes may still be written; empty if not known.
    virtual std::optional<std::uint64_t> FreeBytes() = 0;
};

}  // namespace Rabit
