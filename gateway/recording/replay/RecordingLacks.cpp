#include "recording/replay/RecordingLacks.h"

#include <rabit/base/NumberIn.h>

#include <algorithm>
#include <cstddef>

namespace Rabit::Replay
{
namespace
{

std::string FilesFrom(std::uint64_t first, std::uint64_t last)
{
    const bool isOne = first == last;
    std::string text = isOne ? "file " : "files ";
    text += std::to_string(first);
    if (!isOne)
    {
        text.append(" to ").append(std::to_string(last));
    }
    return text + (isOne ? " is" : " are");
}

// Returns the number of the first file of a recording, which is named after it: NODE_000042_20261123T024640Z.
// If it is named otherwise, `known` counts as the first.
std::uint64_t FirstOf(const std::string &node, const std::string &recording, std::uint64_t known)
{
    const std::size_t begin = node.size() + 1;
    if (!recording.starts_with(node + "_"))
    {
        return known;
    }
    const std::string digits = recording.substr(begin, recording.find('_', begin) - begin);
    return std::min(NumberIn<std::uint64_t>(digits).value_or(known), known);
}

}  // namespace

void RecordingLacks::Add(const Mcap::Contents &file)
{
    const Mcap::TextMap own = MetadataOf(file, "rabit.file");
    const std::string recording = Mcap::ValueOf(own, "recording");
    const auto number = NumberIn<std::uint64_t>(Mcap::ValueOf(own, "number"));
    if (number && !recording.empty())
    {
        _files[{Mcap::ValueOf(own, "node"), recording}].insert(*number);
    }
    const bool isMerged = !MetadataOf(file, "rabit.merge").empty();
    const std::string recorder = isMerged ? "" : Mcap::ValueOf(MetadataOf(file, "rabit.node"), "node");
    // Losses are counted since the beginning of a recording. Those in a merged file are sums of all
    // recorders.
    for (const auto &[topic, count] : MetadataOf(file, "rabit.losses"))
    {
        std::uint64_t &known = _losses[{recorder, recording, topic}];
        known = std::max(known, NumberIn<std::uint64_t>(count).value_or(0));
    }
    for (const Mcap::Metadata &metadata : file.MetadataRecords)
    {
        if (metadata.Name != "rabit.not_recorded")
        {
            continue;
        }
        const std::string node = isMerged ? Mcap::ValueOf(metadata.Values, "node") : recorder;
        for (const auto &[name, reason] : metadata.Values)
        {
            if (!isMerged || (name != "node" && name != "life"))
            {
                _notRecorded[{node, reason}].insert(name);
            }
        }
    }
}

std::vector<std::string> RecordingLacks::Messages() const
{
    std::vector<std::string> lines;
    for (const auto &[of, count] : _losses)
    {
        const auto &[recorder, recording, topic] = of;
        const std::string messages = std::to_string(count) + " messages";
        lines.push_back(recorder.empty() ? topic + ": " + messages + " were not recorded"
                                         : recorder + " did not record " + messages + " of " + topic);
    }
    for (const auto &[why, names] : _notRecorded)
    {
        std::string all;
        for (const std::string &name : names)
        {
            all.append(all.empty() ? "" : ", ").append(name);
        }
        lines.push_back(why.first + " did not record " + all + ": " + why.second);
    }
    return lines;
}

std::vector<std::string> RecordingLacks::Files() const
{
    std::vector<std::string> lines;
    for (const auto &[of, numbers] : _files)
    {
        const auto &[node, recording] = of;
        std::uint64_t next = FirstOf(node, recording, *numbers.begin());
        for (const std::uint64_t number : numbers)
        {
            if (number > next)
            {
                lines.push_back(node + ": " + FilesFrom(next, number - 1) + " missing of recording " +
                                recording);
            }
            next = number + 1;
        }
    }
    return lines;
}

}  // namespace Rabit::Replay
