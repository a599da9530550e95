#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recording/mcap/McapContents.h"
#include "recording/merge/ClockGraph.h"

namespace Rabit::Merge
{

// One file of a recording.
struct LifeFile
{
    std::string Path;
    std::uint64_t Number = 0;  // of the files of that node, in order
    Mcap::Contents Contents;
    Moment Begin = 0;  // log times of its messages
    Moment End = 0;
};

// The recording of one life of a node: all its files, on one clock.
struct Life
{
    std::string Node;
    std::string Host;
    std::vector<LifeFile> Files;  // in order, one at least
    Moment Begin = 0;
    Moment End = 0;
    // Empty if there is no message of Recorder/Clocks in it.
    std::optional<ClockGraph::Clock> Clock;
    std::uint64_t Incarnation = 0;
    Moment SourceToLog = 0;  // from its source clock
};

// What files hold, put in order by lives, and what all of them tell of clocks.
struct Lives
{
    std::vector<Life> All;  // by node and beginning
    ClockGraph Graph;
    std::vector<std::string> Remarks;  // what could not be read, or was passed over, one line each
    std::string Problem;               // why nothing can be done with them; empty: nothing
};

// Opens a file, again and again; throws if it cannot be read.
using OpenFile = std::function<std::unique_ptr<Mcap::ByteSource>(const std::string &path)>;

// Reads of each file what it holds, and the messages of clocks. Two files that are the same one of a
// recording, as `rabit recover` makes them, are taken once: that with more messages.
Lives ReadLives(const OpenFile &open, const std::vector<std::string> &paths);

}  // namespace Rabit::Merge
