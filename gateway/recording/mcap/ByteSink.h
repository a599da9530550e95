#pragma once

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Takes the bytes of a file, one after the other.
class ByteSink
{
public:
    virtual ~ByteSink() = default;
    // Writes all bytes; false if not all could be written. The caller writes nothing after that.
    virtual bool Write(ByteView bytes) = 0;
};

}  // namespace Rabit::Mcap
