#pragma once

#include <rabit/mcap/McapContents.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

// The contents of files, in the order of lives, and the clock reports of all of them.
struct Lives
{
    std::vector<Life> All;  // by node and beginning
    ClockGraph Graph;
    std::vector<std::string> Remarks;  // parts and files that were skipped, one line each
    std::string Problem;               // why the files cannot be used; empty: they can
};

// Opens a file, several times if asked; throws if it cannot be read.
using OpenFile = std::function<std::unique_ptr<Mcap::ByteSource>(const std::string &path)>;

// Reads the contents and the clock reports of each file. Of two copies of one file, as `rabit recover`
// makes them, the one with more messages is taken.
Lives ReadLives(const OpenFile &open, const std::vector<std::string> &paths);

}  // namespace Rabit::Merge
