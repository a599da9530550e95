#pragma once

#include <rabit/mcap/McapContents.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace Rabit::Replay
{

// Collects the gaps that recordings tell of themselves: messages that were dropped or not recorded at all,
// and missing files, between those that are there or before them.
class RecordingLacks
{
public:
    void Add(const Mcap::Contents &file);
    // Messages, in lines. Their text comes from the files, and may hold any bytes.
    std::vector<std::string> Messages() const;
    // Files, likewise.
    std::vector<std::string> Files() const;

private:
    // By recorder, which is empty for a merged file, recording and topic.
    std::map<std::tuple<std::string, std::string, std::string>, std::uint64_t> _losses;
    std::map<std::pair<std::string, std::string>, std::set<std::string>> _notRecorded;  // by node and reason
    std::map<std::pair<std::string, std::string>, std::set<std::uint64_t>> _files;  // by node and recording
};

}  // namespace Rabit::Replay
