#pragma once

#include <rabit/mcap/ByteSource.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapWriter.h>

namespace Rabit::Mcap
{

// The result of a recovery.
struct Recovered
{
    std::uint64_t Messages = 0;
    std::uint64_t LostMessages = 0;     // without a channel, or too large
    std::vector<std::string> Problems;  // what could not be read, one line each
    bool IsWritten = false;             // whether the other file is whole
};

// Writes all that can be read of a file into another file, in the same order, with an index, and ends that
// file: nothing may be added to the writer afterwards. The source may be truncated, or have damaged chunks or
// none at all. No content of it throws. If the writer's sink fails, IsWritten is false.
Recovered Recover(ByteSource &source, McapWriter &writer);

}  // namespace Rabit::Mcap
