#pragma once

#include <rabit/RabitQueueReceipt.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "CommonOptions.h"
#include "ReplayNode.h"
#include "Wakeup.h"
#include "recording/replay/NodeRenames.h"
#include "recording/replay/PostTimes.h"
#include "recording/replay/ReplayPlan.h"
#include "recording/replay/ReplayPresence.h"
#include "recording/replay/ReplayTimeline.h"

namespace Rabit::Tool
{

// The nodes of a replay. Keeps each in the network while it was there, and plays messages. Main thread only.
class ReplayFleet
{
public:
    using Duration = std::chrono::nanoseconds;

    struct Counts
    {
        std::uint64_t Messages = 0;
        std::uint64_t Restored = 0;  // not among them
        std::uint64_t QueueMessages = 0;
        std::uint64_t Undelivered = 0;  // of these
        std::uint64_t Undecodable = 0;  // undecodable, and so not played
        std::uint64_t Replaced = 0;     // by a newer one before they were written
        std::uint64_t AgesNotKept = 0;
    };

    // All arguments must outlive the object. Reports streams that cannot be played.
    ReplayFleet(const Replay::ReplayPlan &plan, const Replay::NodeRenames &renames,
                const GatewayConfig &network, const CommonOptions &options, Wakeup &wakeup);

    // The new names of all nodes.
    std::vector<std::string> Names() const;
    // Keeps all nodes in the network from now on: for a replay that leaves them no time to come.
    void KeepAll() { _keepsAll = true; }
    // Makes each message wait until the gateway has taken the one before it of its name, even if the recorded
    // gateway skipped that one.
    void WaitForTurns() { _waitsForTurns = true; }

    // Adds the nodes that were there at that time. Throws NetworkError, as all functions below.
    void Begin(const std::vector<Replay::ReplayItem> &known, Replay::Time at);
    // The replay has jumped to `to`; `restored` are the last values before it.
    void Jump(const std::vector<Replay::ReplayTimeline::Due> &restored, Replay::Time to);
    void Play(const Replay::ReplayTimeline::Due &due);
    // Makes nodes come and go as they did.
    void Follow(Replay::Time position);
    // Returns a name that another live node has; empty if there is none.
    std::string TwiceName() const;
    // True if the outcome of every queue message is known.
    bool IsSettled() const { return _receipt->GetCounts().Pending == 0; }
    // The counts so far.
    Counts CountsNow() const;

private:
    struct Stream
    {
        const MessageType *Type = nullptr;             // null: it cannot be played
        std::shared_ptr<const DynamicType> OfFleet{};  // as it was recorded
    };
    Stream Prepare(const Replay::ReplayStream &stream);
    void Note(const Replay::ReplayItem &item);
    void Post(const Replay::ReplayTimeline::Due &due);
    void Send(const Replay::ReplayItem &item);
    void Come(const std::string &node);
    void Leave(const std::string &node);
    std::vector<ReplayNode::Topic> TopicsOf(const std::string &node) const;

    const Replay::ReplayPlan &_plan;
    const Replay::NodeRenames &_renames;
    const GatewayConfig _network;
    const CommonOptions &_options;
    Wakeup &_wakeup;
    bool _keepsAll = false;
    bool _waitsForTurns = false;
    std::vector<Stream> _streams;                  // in the order of the plan's streams
    std::map<std::string, std::string> _messages;  // NODE/MESSAGE to the type that it is played with
    Replay::ReplayPresence _presence;
    Replay::PostTimes _times;
    std::vector<Replay::Time> _lastPosted;  // by stream: log time of the last post
    Replay::Time _jumpedTo = 0;
    std::map<std::string, std::unique_ptr<ReplayNode>> _nodes;  // those in the network, by recorded name
    const std::shared_ptr<RabitQueueReceipt> _receipt = std::make_shared<RabitQueueReceipt>();
    Counts _counts;
};

}  // namespace Rabit::Tool
