#pragma once

#include <rabit/RabitReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "CommonOptions.h"
#include "Wakeup.h"

namespace Rabit::Tool
{

// The network could not be joined, or a service in it not be offered.
class NetworkError : public std::runtime_error
{
public:
    explicit NetworkError(const std::string &message, bool doctorHelps = false)
        : std::runtime_error(message), _doctorHelps(doctorHelps)
    {
    }
    // True if `rabit doctor` would find the cause.
    bool DoctorHelps() const { return _doctorHelps; }

private:
    bool _doctorHelps;
};

// This program as a member of the network, as long as the object lives. Main thread only.
class FleetSession
{
public:
    using Node = FleetExplorer::Node;

    // Throws NetworkError, and ConfigError for a configuration that no network could mend. If --node names
    // this tool, first listens under another name, for 1.5 s as a rule; throws std::runtime_error if a node
    // has that name. `prepare` is called before the network is joined, so what it connects to messages of
    // the workspace misses no post. It may call Workspace, Seconds and Notify.
    FleetSession(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup,
                 const std::function<void(FleetSession &)> &prepare = {});
    ~FleetSession();

    FleetExplorer &Explorer() { return *_explorer; }
    RabitWorkspace &Workspace() { return _workspace; }
    // Both list the nodes in their NaturalOrder. Problems of RosNodes are left out.
    std::vector<Node> Nodes() const;
    Gateway::Fleet Fleet() const;

    static constexpr double Forever = 1e8;
    // Waits until `holds` returns true, for at most `seconds` from the start of the session.
    bool WaitUntil(
        double seconds, const std::function<bool()> &holds = [] { return false; });
    // Waits until `holds` returns true, for --wait at most, but not for announcements that cannot come any
    // more (Offers::AreAllThere). Returns the last result of `holds`. `pattern`: the nodes whose
    // announcements matter.
    bool WaitForOffers(const std::string &pattern, const std::function<bool()> &holds);
    // Waits until `isDecided` returns true, for --wait at most, and also asks it when all nodes should
    // have been heard. Returns its last result.
    bool WaitUntilDecided(const std::function<bool()> &isDecided);
    // Waits until all nodes that are there are heard, and `isWhole` returns true; for 1.5 s at least, unless
    // IsFleetKnown. Without --wait it waits 3 s longer than usual for what is still lacking, as a node may be
    // answering others.
    void WaitForEverybody(const std::function<bool()> &isWhole);
    // True if every node that is there is heard, as far as this program can know. Nodes that beat more seldom
    // than others may be missing.
    bool IsEverybodyHeard() const;
    // True if all nodes that are heard told that they hear the same nodes as this program. Then every node
    // that any of them hears is heard here, however slow its radio is.
    bool IsFleetKnown() const;
    // Says why no live node fits the pattern.
    std::string NoSuchNode(const std::string &pattern) const;
    // The first of these names that a live node or another tool has; empty: none.
    std::string TakenOf(const std::vector<std::string> &names) const;
    // The readers of these messages, by message. To be called once.
    std::map<std::string, FleetExplorer::Subscribers> SubscribersOf(const std::vector<std::string> &messages);
    // Makes WaitUntil ask `holds` again; any thread.
    void Notify() { _wakeup.Notify(); }
    // Seconds since the start of the session. Any thread.
    double Seconds() const;
    // True if a node was heard.
    bool IsAnybodyThere() const { return !_explorer->Nodes().empty(); }
    // True if another live node has the name of this one.
    bool IsTwice() const;
    // Reports all problems of the gateway.
    void TellProblems() const;
    // Reports that no node was heard, with known reasons. Listens 2.2 s more for fleets with keys. Returns
    // the exit code.
    int NobodyThere();

private:
    void TellOfKeys();

    const GatewayConfig _config;
    const CommonOptions &_options;
    Wakeup &_wakeup;
    RabitWorkspace _workspace;
    RabitReactor _reactor{_workspace};
    FleetExplorer *_explorer = nullptr;
    std::shared_ptr<Gateway::Fleet> _fleet = std::make_shared<Gateway::Fleet>();
    std::chrono::steady_clock::time_point _start = std::chrono::steady_clock::now();
    std::thread _runner;
};

// The error line for a name that a node has.
std::string NameIsTaken(const std::string &name);
// The node; null if it is not known.
const FleetSession::Node *FindNode(const std::vector<FleetSession::Node> &nodes, const std::string &node);

}  // namespace Rabit::Tool
