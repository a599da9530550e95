#pragma once

#include <rabit/mcap/McapContents.h>

#include <string>

namespace Rabit::Mcap
{

// Every kind of channel that recorders write, and merged recordings have (metadata `rabit.kind`).
enum class ChannelKind
{
    Posted,      // posts of the recording node
    Mirrored,    // posts of another node, as they came live; `knew` in a merged recording
    Backfilled,  // posts of another node that came later, at the times of the posts
    QueueSent,
    QueueReceived,
    QueueRefused,
    Recorder,  // what the recorder itself says, in JSON
    Other      // written by another program
};

// The meaning of a channel: the one place that knows the kinds and their topics.
struct RecordedChannel
{
    ChannelKind Kind = ChannelKind::Other;
    // The node that posted the message, or recorded the channel of a queue; empty if the channel does not say
    // so.
    std::string Node;
    // The name of the posted message; empty for queues and the recorder's own channels.
    std::string Message;
    // The node that recorded the channel; empty if only the file's metadata say so.
    std::string Recorder;
};

// Returns the meaning of a channel by its topic and its metadata. Node and message of a
// channel of another program are those of a topic `NODE/MESSAGE`. Keeps no state.
RecordedChannel Describe(const Channel &channel);

}  // namespace Rabit::Mcap
