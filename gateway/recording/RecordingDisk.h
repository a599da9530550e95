#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recording/mcap/ByteSink.h"

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
        // Returns when all that was written would outlast a loss of power; false if that cannot be had.
        virtual bool Sync() = 0;
    };
    struct Entry
    {
        std::string Name;
        std::uint64_t Bytes = 0;
    };

    // A new file; null, with a reason, if there is one of that name or it cannot be made.
    virtual std::unique_ptr<File> Create(const std::string &name, std::string &reason) = 0;
    // All files, in any order.
    virtual std::vector<Entry> List() = 0;
    virtual bool Remove(const std::string &name) = 0;
    // What may still be written; empty: not known.
    virtual std::optional<std::uint64_t> FreeBytes() = 0;
};

}  // namespace Rabit
