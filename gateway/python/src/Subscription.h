// The newest values of messages, for Python.
#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/RabitMessageLease.h>
#include <rabit/RabitWorkspace.h>

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Codec.h"
#include "Waitable.h"

namespace Rabit::Python
{

// A value that came.
struct Received
{
    py::object Value;
    std::string Node;     // the origin; empty: this node
    std::string Message;  // its local name: `uav1/Pose`
    PostTime Time;

    double Age() const;    // seconds since the post
    double Stamp() const;  // seconds since 1970 (UTC), by the clock of the origin
};

// One subscription: a local name, or one message of all nodes that fit a pattern. Of each node it gives the
// newest value, never one twice; values that come meanwhile are skipped.
//
// Threads: values are posted on any thread, which needs no GIL. Take needs it.
class Subscription : public std::enable_shared_from_this<Subscription>
{
public:
    // Reads nothing more once the workspace is gone, and keeps it alive while a value is read. `pattern` is
    // of nodes; empty: `message` is a local name.
    Subscription(const std::shared_ptr<RabitWorkspace> &workspace, std::string pattern, std::string message,
                 std::shared_ptr<MessageClass> type);

    const std::string &Pattern() const { return _pattern; }
    const std::string &Message() const { return _message; }
    std::string Name() const { return _pattern.empty() ? _message : _pattern + "/" + _message; }
    const std::shared_ptr<MessageClass> &Type() const { return _type; }

    // Reads the local message of that node, or of this one (empty), from now on. No GIL is needed.
    // Returns why not: the name has another type. Empty: it is read.
    std::string Attach(const std::string &node);
    bool HasAttached(const std::string &node) const;

    bool IsReady() const;
    // The next new value.
    std::optional<Received> Take();
    // The values of all nodes, also those that were taken before.
    std::vector<Received> All();

    Waitable &Ready() { return _shared->Ready; }
    bool IsClosed() const;
    // Nothing comes any more, and nothing of the workspace is used.
    void Close();

private:
    struct Source
    {
        std::string Node;
        std::string LocalName;
        std::shared_ptr<RabitWorkspace> Workspace;  // outlives the lease
        std::shared_ptr<RabitMessage> Own;
        std::unique_ptr<RabitMessageLease> Lease;
        RabitScopedConnection Connection;
        bool IsQueued = false;  // guarded by Shared::Mutex
    };
    // Outlives the subscription while a handler runs.
    struct Shared
    {
        mutable std::mutex Mutex;
        std::deque<std::weak_ptr<Source>> New;  // sources with a value that was not taken
        bool IsClosed = false;
        Waitable Ready;
    };

    static void Queue(Shared &shared, const std::shared_ptr<Source> &source);
    Received ReceivedOf(const Source &source) const;

    const std::weak_ptr<RabitWorkspace> _workspace;
    const std::string _pattern;
    const std::string _message;
    const std::shared_ptr<MessageClass> _type;
    const std::shared_ptr<Shared> _shared = std::make_shared<Shared>();
    std::map<std::string, std::shared_ptr<Source>> _sources;  // guarded by Shared::Mutex
};

}  // namespace Rabit::Python
