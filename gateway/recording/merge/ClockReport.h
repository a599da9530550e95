#pragma once

#include <rabit/mcap/McapRecords.h>

#include <optional>
#include <string>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// A node's report about clocks, which its recording holds once a second: a message of
// `<node>/Recorder/Clocks`.
struct ClockReport
{
    struct Peer
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        Moment SourceToLog = 0;             // from its source clock to the log times of the file
        std::optional<Moment> UncertainBy;  // half of the last round trip; empty: there was none
    };
    std::uint64_t Incarnation = 0;  // of the node itself
    Moment SourceToLog = 0;         // from its own source clock
    std::vector<Peer> Peers;
};

// Reads a report; nothing if the text is none. Malformed peers are left out.
std::optional<ClockReport> ReadClockReport(Mcap::ByteView json);

// Returns the report for a file whose log times are later by `later`; nothing if the text is no report.
std::optional<Mcap::Bytes> ShiftClockReport(Mcap::ByteView json, Moment later);

}  // namespace Rabit::Merge
