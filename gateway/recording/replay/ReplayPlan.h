#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "recording/mcap/McapContents.h"

namespace Rabit::Replay
{

// One thing that is played: what one recorder wrote of one message or queue, in all its files.
struct ReplayStream
{
    enum class Kind
    {
        Message,  // a post of a node
        Queue,    // a message for a queue
        Fleet     // what a recorder knew of who was there
    };
    Kind What = Kind::Message;
    std::string Node;  // who posted or sent it; of Fleet who recorded it
    std::string Name;  // of the message or queue
    std::string Peer;  // of a queue: whose it is
    std::string Type;  // IDL name
    std::string IdlText;
    bool IsTelemetry = false;
    std::string Recorder;  // who recorded it; empty: the file does not say
};

// What of the recordings is to be played.
struct PlanSettings
{
    // Messages by `NODE/MESSAGE` as they were recorded; `*` and `?` are wildcards. Empty: all that nodes
    // published, or had from others.
    std::vector<std::string> Include{};
    std::vector<std::string> Exclude{};
    // Queues by `NODE/QUEUE`: whose they are.
    std::vector<std::string> Queues{};
};

struct ReplayPlan
{
    std::vector<ReplayStream> Streams;
    // Of each file: by channel the stream that it belongs to.
    std::vector<std::map<std::uint16_t, std::size_t>> Channels;
    // Who posts, sends, or was recorded as a node, by their recorded names.
    std::set<std::string> Nodes;
    // Domains in which they were, as far as the files say.
    std::set<std::string> Domains;
};

// Where a message was recorded by several, that of its own node is played; else that of who has most of it.
// Queue messages as they were sent, or where that was not recorded, as they were received. Names that no node
// or message can have are passed over, and what is not CDR with an IDL text.
ReplayPlan PlanReplay(const std::vector<const Mcap::Contents *> &files, const PlanSettings &settings);

}  // namespace Rabit::Replay
