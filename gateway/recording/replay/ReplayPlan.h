#pragma once

#include <rabit/mcap/McapContents.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace Rabit::Replay
{

// One stream that is played: one message or queue, as one recorder wrote it, in all its files.
struct ReplayStream
{
    enum class Kind
    {
        Message,  // a post of a node
        Queue,    // a message for a queue
        Fleet     // the nodes that a recorder knew
    };
    Kind What = Kind::Message;
    std::string Node;  // that posted or sent it; of Fleet the recorder
    std::string Name;  // of the message or queue
    std::string Peer;  // the node of the queue
    std::string Type;  // IDL name
    std::string IdlText;
    std::string Qos;       // as it was recorded
    std::string Recorder;  // the node that recorded it; empty: not known
};

// Selects the messages that are played.
struct PlanSettings
{
    // Messages by `NODE/MESSAGE` as they were recorded; `*` and `?` are wildcards. Empty: all that nodes
    // published, or had from others.
    std::vector<std::string> Include{};
    std::vector<std::string> Exclude{};
    // Queues by `NODE/QUEUE`, where NODE is the node that has the queue.
    std::vector<std::string> Queues{};
};

struct ReplayPlan
{
    std::vector<ReplayStream> Streams;
    // For each file, the stream of each channel.
    std::vector<std::map<std::uint16_t, std::size_t>> Channels;
    // The nodes that post, send, or were recorded, by their recorded names.
    std::set<std::string> Nodes;
    // Domains in which they were, as far as the files say.
    std::set<std::string> Domains;
    // Lines about gaps: those that the files tell of themselves (RecordingLacks), and messages of which
    // another recorder has more. They may hold any bytes that the files hold.
    std::vector<std::string> Lacks;
};

// Plans a replay. If several nodes recorded a message, the recording of its own node is played, or else the
// one with most messages. Queue messages are played as they were sent, or else as they were received.
// Channels with invalid names, or without CDR and an IDL text, are ignored; Lacks tells of the latter.
ReplayPlan PlanReplay(const std::vector<const Mcap::Contents *> &files, const PlanSettings &settings);

}  // namespace Rabit::Replay
