#pragma once

#include "recording/mcap/ByteSource.h"
#include "recording/mcap/McapContents.h"
#include "recording/mcap/McapWriter.h"

namespace Rabit::Mcap
{

// What of a file was taken over into another.
struct Recovered
{
    std::uint64_t Messages = 0;
    std::uint64_t LostMessages = 0;     // without a channel, or too large
    std::vector<std::string> Problems;  // what could not be read, one line each
    bool IsWritten = false;             // whether the other file is whole
};

// Writes all that can be read of a file into another, in the order in which it was written, with an index,
// and ends that. Whatever the file holds: it was truncated, has damaged chunks or none at all.
Recovered Recover(ByteSource &source, McapWriter &writer);

}  // namespace Rabit::Mcap
