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

// The nodes of a replay: has each there while it was, and plays to the network what it is told to. Main
// thread only.
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
        std::uint64_t Undecodable = 0;  // and not played
        std::uint64_t Replaced = 0;     // by a newer one before they were written
        std::uint64_t AgesNotKept = 0;
    };

    // All that is handed over must outlive it. Tells of what cannot be played.
    ReplayFleet(const Replay::ReplayPlan &plan, const Replay::NodeRenames &renames,
                const GatewayConfig &network, const CommonOptions &options, Wakeup &wakeup);

    // New names, of all nodes.
    std::vector<std::string> Names() const;
    // Has all nodes there from now on, whatever was then: for a replay that leaves them no time to come.
    void KeepAll() { _keepsAll = true; }
    // Waits with each message until the one before it of its name has had its turn, also where it did not
    // then.
    void WaitForTurns() { _waitsForTurns = true; }

    // Has those nodes come that were there when that was recorded. Throws NetworkError, as all that follow.
    void Begin(const std::vector<Replay::ReplayItem> &known, Replay::Time at);
    // The replay has jumped there, and this is what was known.
    void Jump(const std::vector<Replay::ReplayTimeline::Due> &restored, Replay::Time to);
    void Play(const Replay::ReplayTimeline::Due &due);
    // Has nodes come and go as they did.
    void Follow(Replay::Time position);
    // A name that another live node has; empty: none.
    std::string TwiceName() const;
    // Whether it is known what became of all queue messages.
    bool IsSettled() const { return _receipt->GetCounts().Pending == 0; }
    // As it is now.
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
    std::vector<Stream> _streams;                  // as those of the plan
    std::map<std::string, std::string> _messages;  // NODE/MESSAGE to the type that it is played with
    Replay::ReplayPresence _presence;
    Replay::PostTimes _times;
    std::vector<Replay::Time> _lastPosted;  // by stream: when that was recorded which was posted last
    Replay::Time _jumpedTo = 0;
    std::map<std::string, std::unique_ptr<ReplayNode>> _nodes;  // those that are there, by recorded name
    const std::shared_ptr<RabitQueueReceipt> _receipt = std::make_shared<RabitQueueReceipt>();
    Counts _counts;
};

}  // namespace Rabit::Tool
