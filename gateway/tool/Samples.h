#pragma once

#include <rabit/dynamic/DynamicMessage.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "CommonOptions.h"
#include "FleetSession.h"
#include "FleetType.h"
#include "ForeignArguments.h"

namespace Rabit::Tool
{

// One value of a message, as it arrived.
struct Sample
{
    std::string Node;                 // empty: of a foreign program
    std::vector<std::uint8_t> Bytes;  // CDR with its encapsulation
    double Age = 0.0;                 // seconds, when it came
    double Stamp = 0.0;               // of its post, by the wall clock of its node; GPS seconds
    double At = 0.0;                  // when it came, seconds since the start of the session
};

// The values of a message of one or several nodes, each once, as they come. The type comes from the nodes. Or
// those of a topic of foreign programs.
class Samples
{
public:
    // `what`: `uav1/Pose`; the node may be a pattern; `Pose` alone means all nodes.
    Samples(FleetSession &session, const std::string &what);
    // Takes what comes from now on. The topic must be in the configuration of the session (AddForeign).
    Samples(FleetSession &session, const ForeignArgument &topic);

    // Waits until a node publishes the message and its type has come; then subscribes. Waits at most until
    // `until`, in seconds from the start of the session, and not for what no node can announce any more.
    // Returns Good, or reports the reason and returns the exit code. Foreign topics need no Open.
    int Open(double until);
    const DynamicType &Type() const { return *_type.Type; }
    const std::string &Message() const { return _message; }

    // Waits until a value has come, or until `until`, in seconds from the start of the session. Returns all
    // values so far.
    std::vector<Sample> Take(double until);
    // Values that were dropped because they came faster than they were taken.
    std::uint64_t Missed() const;

private:
    // Bytes kept for Take.
    static constexpr std::size_t MostBytes = 16u << 20;

    struct Inbox
    {
        std::mutex Mutex;
        std::vector<Sample> Waiting;
        std::size_t Bytes = 0;
        std::uint64_t Missed = 0;
    };

    std::vector<const FleetSession::Node *> Publishers(const std::vector<FleetSession::Node> &nodes) const;
    void Follow(const std::string &node, const std::string &local);
    void FollowNew();

    FleetSession &_session;
    std::string _pattern;  // of nodes; empty: a foreign topic
    std::string _message;
    std::string _typeName;
    std::uint64_t _definition = 0;
    FleetType _type;
    std::shared_ptr<Inbox> _inbox = std::make_shared<Inbox>();
    std::map<std::string, std::shared_ptr<DynamicMessage>> _followed;
};

// Reports that no node that fits the pattern publishes the message, with the nearest right word.
void TellNobodyPublishes(const FleetSession &session, const std::string &pattern, const std::string &message);

// Joins the network for the values of `what` alone, and calls the body once a node publishes it, or at once
// for a topic of foreign programs. Returns the body's result; or reports why it was not called, and returns
// the exit code. Throws ConfigError as TakeForeign and AddForeign do.
int ListenTo(const CommonOptions &options, const std::string &what, const ForeignOptions &foreign,
             Wakeup &wakeup, const std::function<int(FleetSession &session, Samples &samples)> &body);

}  // namespace Rabit::Tool
