#pragma once

#include <rabit/mcap/McapRecords.h>

namespace Rabit::Mcap
{

// Takes the bytes of a file, one after the other. The program implements it: over a file, or in memory. A
// writer calls it on its own thread alone.
class ByteSink
{
public:
    virtual ~ByteSink() = default;
    // Writes all bytes; false if not all could be written. The caller writes nothing after that.
    virtual bool Write(ByteView bytes) = 0;
};

}  // namespace Rabit::Mcap
