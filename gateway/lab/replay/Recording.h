#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapContents.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/RecordedMessages.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::WhatIf
{

using Replay::Time;

// One process of a node, from its first recorded message to its last.
struct RecordedLife
{
    std::string Node;
    Time Begin = 0;
    Time End = 0;
    std::string Domain{};
    // The text of its configuration file; empty: it was made in code.
    std::string Configuration{};
    // For a simulated network: that of its file, without keys, recordings, foreign topics and rules for types
    // that nobody used. It is completed by what the node published, received and accepted. Of several paths
    // the first is left.
    GatewayConfig Config{};
};

// A recorded flight: the messages of its nodes on one time line, and how the nodes were configured.
class Recording
{
public:
    static constexpr std::size_t MostLives = 1000;
    // Longest recording that is flown.
    static constexpr Time Longest = Time{24} * 3600 * 1'000'000'000;
    // Most seconds, summed over each node with each other one and with itself, that are flown: about an hour
    // of a processor. Ten nodes may fly for a day, and a hundred for an hour.
    static constexpr double MostPairSeconds = 5e7;

    // Registers the types of the recording. Throws std::runtime_error if a file cannot be read, or if the
    // files cannot be flown.
    explicit Recording(const std::vector<std::string> &names);

    const Replay::ReplayPlan &Plan() const { return _plan; }
    Replay::RecordedMessages &Messages() { return *_messages; }
    // By their beginnings. A node that only others recorded has one life, from shortly before its first
    // message until shortly after its last.
    const std::vector<RecordedLife> &Lives() const { return _lives; }
    // Of the flight: its first message, and its last one, or the first end of those nodes that ended together
    // with the last one.
    Time Begin() const;
    Time End() const;
    // When messages of another node arrived, and when they were posted, as the recorder knew it.
    struct Arrival
    {
        Time At = 0;
        Time Posted = 0;
    };
    using Stream = std::pair<std::string, std::string>;  // origin and message
    // The recorded arrivals by the node that received them.
    std::map<std::string, std::map<Stream, std::vector<Arrival>>> Arrivals() const;

    const std::vector<std::string> &Notes() const { return _notes; }

private:
    // The messages and queue messages that a node received, as its recording tells.
    struct Used
    {
        std::map<Stream, std::string> Receives;                   // to type
        std::map<std::string, std::set<std::string>> QueueTypes;  // by queue
    };

    void RegisterTypes();
    void FindLives();
    void AddLife(RecordedLife life);
    void AddUnrecorded();
    // How long each two lives are there together, summed.
    double PairSeconds() const;
    void FindUses(const Mcap::Contents &contents);
    GatewayConfig ConfigOf(const RecordedLife &life);

    std::vector<std::string> _names;
    std::vector<std::unique_ptr<Mcap::FileSource>> _files;
    std::vector<std::unique_ptr<Mcap::Contents>> _contents;
    Replay::ReplayPlan _plan;
    std::unique_ptr<Replay::RecordedMessages> _messages;
    std::vector<RecordedLife> _lives;
    std::map<std::string, Used> _used;  // by node
    std::vector<std::string> _notes;
};

}  // namespace Rabit::WhatIf
