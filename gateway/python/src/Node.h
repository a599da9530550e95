// A node whose program is written in Python.
#pragma once

#include <rabit/RabitReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/gateway/GatewayConfig.h>

#include <sys/types.h>

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "Agreement.h"
#include "InboundQueue.h"
#include "PythonManager.h"
#include "Receipt.h"
#include "Subscription.h"

namespace Rabit
{
class RecorderManager;
}

namespace Rabit::Python
{

// Loads a library that was linked without Rabit's libraries: it uses those in this module. So the types that
// it registers are known here. Throws std::runtime_error.
void *LoadLibrary(const std::string &path);

// A reactor with a gateway, in a workspace of its own, on threads of its own that never wait for the GIL;
// only managers written in Python do. So a program that computes does not silence its node.
//
// A node starts and stops once. All functions need the GIL, and release it where they wait. In a forked
// process the threads of the node do not exist: there every function throws, and nothing is torn down.
class Node
{
public:
    explicit Node(GatewayConfig config);
    ~Node();
    Node(const Node &) = delete;
    Node &operator=(const Node &) = delete;

    const GatewayConfig &Config() const { return _config; }
    std::string Name() const { return _config.Node; }
    bool IsRunning() const { return HasThreads() && !_parts->IsEnding; }
    // Started, and not yet ended.
    bool HasThreads() const { return _parts && _parts->HasStarted; }

    // Before Start. The name of a Python manager's own queue is its name.
    std::shared_ptr<InboundQueue> AddQueue(const std::string &name, int capacity);
    PythonManager &AddManager(const std::string &name, const py::object &object, double period);
    // Adds the managers of a library: calls its function
    // extern "C" void rabit_add_managers(RabitReactor &, GatewayConfig &, RabitWorkspace &).
    void AddLibrary(const std::string &path);

    // Throws ConfigError, and std::system_error without a thread. After that it may be called again.
    void Start();
    // Leaves the network. Messages without an outcome get one. False in a manager of this node, which cannot
    // wait for its own end: then the streams and the managers are told to end, and the next Stop, in another
    // thread, ends the node. Ctrl-C ends the wait for a manager with KeyboardInterrupt; the next Stop goes
    // on.
    bool Stop();

    std::shared_ptr<Subscription> Subscribe(const std::string &pattern, const std::string &message,
                                            std::shared_ptr<MessageClass> type);
    void Unsubscribe(const std::shared_ptr<Subscription> &subscription);
    // Posts a local message, which goes to other nodes if the configuration publishes it.
    void Post(const std::string &name, py::handle value);
    std::shared_ptr<Receipt> Send(const std::string &address, py::handle value, std::optional<double> expire);
    const std::shared_ptr<Outcomes> &KnownOutcomes() const { return _outcomes; }
    Gateway::Fleet Fleet();
    // Waits until the gateway has taken what was posted before.
    bool Flush(double seconds);
    // The names of the messages here, and those of other nodes as they announce them.
    std::vector<std::string> Messages();
    // The claims and the shared table, also once the node has ended. Throws ConfigError if the configuration
    // has no `agreement`.
    std::shared_ptr<Agreement> Agreed();
    // Throw as the other functions do once the node has ended, and in a forked process. CheckNetwork throws
    // before Start, too.
    void Check() { static_cast<void>(Use()); }
    void CheckNetwork() { static_cast<void>(UseNetwork()); }

private:
    struct Parts
    {
        RabitWorkspace Workspace;
        std::unique_ptr<RabitReactor> Reactor = std::make_unique<RabitReactor>(Workspace);
        std::map<std::string, std::pair<std::shared_ptr<MessageClass>, std::shared_ptr<RabitMessage>>> Posted;
        std::shared_ptr<Gateway::Fleet> Fleet = std::make_shared<Gateway::Fleet>();
        std::vector<PythonManager *> Managers;  // the reactor's
        FleetExplorer *Explorer = nullptr;
        std::shared_mutex InUse;              // by calls that use the explorer without the GIL
        std::mutex Changing;                  // held by Start, and by Stop, without the GIL
        RecorderManager *Recorder = nullptr;  // null: nothing is recorded
        std::thread Runner;
        std::atomic<bool> HasStarted{false};
        std::atomic<bool> IsEnding{false};  // never false again, also if Start is not done yet
        std::atomic<bool> HasEnded{false};  // the runner is done
        Waitable Ended;
        std::mutex Mutex;
        std::vector<std::weak_ptr<Subscription>> Subscriptions;  // guarded
        std::vector<std::shared_ptr<InboundQueue>> Queues;
        std::map<std::string, double> Expires;  // by address
        std::shared_ptr<Agreement> Agreed;      // null: the configuration has none
    };

    // Holding what they return keeps the parts alive while the GIL is released.
    std::shared_ptr<Parts> Use();
    std::shared_ptr<Parts> UseNetwork();
    std::runtime_error StoppedError() const;
    // All messages of a link live equally long: throws py::value_error for another time than before.
    void SetExpiry(const std::string &address, double seconds);
    static void AttachAll(Parts &parts);
    static void CloseStreams(Parts &parts);
    // On a thread of its own, once the managers are ready.
    static void RunReactor(Parts &parts, const std::string &name, std::future<void> isReady);
    bool IsForeign(const std::string &name) const;

    GatewayConfig _config;
    const pid_t _process;
    std::shared_ptr<Parts> _parts;             // until the managers have ended
    const std::shared_ptr<Agreement> _agreed;  // null: the configuration has none
    std::atomic<std::uint64_t> _nextReceipt{1};
    const std::shared_ptr<Outcomes> _outcomes = std::make_shared<Outcomes>();
};

}  // namespace Rabit::Python
