#pragma once

#include <rabit/mcap/McapRecords.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// One stream of a recording: what becomes a channel of the file.
struct RecordingStream
{
    std::string Topic;
    std::string Encoding = "cdr";
    std::string SchemaName;  // with its text; empty: none
    std::string SchemaEncoding = "omgidl";
    std::string SchemaText{};
    Mcap::TextMap Metadata{};
    // True: a message holds until the next one. The last one is repeated at the beginning of each file, so
    // that a file can be understood without those before it.
    bool IsState = false;
};

// One message of a stream. Times are UTC, nanoseconds since 1970.
struct RecordingItem
{
    std::uint32_t Stream = 0;
    std::uint32_t Sequence = 0;
    std::uint64_t LogTime = 0;
    std::uint64_t PublishTime = 0;
    Mcap::Bytes Data;
};

}  // namespace Rabit
