#pragma once

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Where the bytes of a file go, one after the other.
class ByteSink
{
public:
    virtual ~ByteSink() = default;
    // All of them; false if not all could be written. Nothing is written after that.
    virtual bool Write(ByteView bytes) = 0;
};

}  // namespace Rabit::Mcap
