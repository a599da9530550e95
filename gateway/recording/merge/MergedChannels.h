#pragma once

#include <rabit/mcap/McapWriter.h>

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "recording/merge/MergePlan.h"

namespace Rabit::Merge
{

// The channels of a merged file. Messages that a node posted keep their topic. Messages from other nodes
// get the topic of a known one: `uav2/Pose` in the recording of uav1 becomes
// `uav1/Recorder/knew/uav2/Pose`. Each life has channels of its own, told apart by their metadata:
//   rabit.recorded_by   the node whose recording it is from
//   rabit.life          1, 2, ...; with rabit.incarnation
//   rabit.kind          `knew` for received messages; else as in the recording
//   rabit.node, rabit.message   of `knew`: the node that posted it, and its name there
class MergedChannels
{
public:
    // The arguments must outlive the object.
    MergedChannels(const Lives &lives, const MergePlan &plan, Mcap::McapWriter &writer);

    // Times within the data of a message that must be put on the time line, too.
    enum class Inside
    {
        Nothing,
        Clocks,  // ClockReport
        LogLine  // foxglove.Log
    };
    struct Made
    {
        std::uint16_t Number = 0;
        Inside Times = Inside::Nothing;
    };
    // Returns the channel for one in a file of that life; empty if there are too many.
    std::optional<Made> Of(std::size_t life, const Mcap::Contents &contents, std::uint16_t channel);
    // Returns the channel `uav1/Recorder/TimeLine`, which tells how a life is put on the time line.
    std::optional<std::uint16_t> TimeLineOf(std::size_t life);
    // Returns the merged name of a topic in the recording of that life.
    std::string TopicOf(std::size_t life, const Mcap::Channel &channel) const;

private:
    std::uint16_t SchemaOf(const std::string &name, const std::string &encoding, const std::string &text);
    std::optional<std::uint16_t> Make(std::size_t life, std::uint16_t schema, const std::string &topic,
                                      const std::string &encoding, Mcap::TextMap metadata);

    const Lives &_lives;
    const MergePlan &_plan;
    Mcap::McapWriter &_writer;
    std::map<std::tuple<std::string, std::string, std::string>, std::uint16_t> _schemas;
    std::map<std::tuple<std::size_t, std::uint16_t, std::string, std::string>, std::optional<std::uint16_t>>
        _channels;  // life, schema, topic, encoding
};

}  // namespace Rabit::Merge
