#pragma once

#include <rabit/RabitReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "CommonOptions.h"
#include "Wakeup.h"

namespace Rabit::Tool
{

// The network could not be joined.
class NetworkError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

// This program as a member of the network, as long as the object lives. Main thread only.
class FleetSession
{
public:
    using Node = FleetExplorer::Node;

    // Throws NetworkError.
    FleetSession(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup);
    ~FleetSession();

    FleetExplorer &Explorer() { return *_explorer; }
    RabitWorkspace &Workspace() { return _workspace; }
    std::vector<Node> Nodes() const { return _explorer->Nodes(); }
    Gateway::Fleet Fleet() const;

    static constexpr double Forever = 1e8;
    // Waits until `holds` returns true, for at most `seconds` from the start of the session.
    bool WaitUntil(double seconds, const std::function<bool()> &holds);
    // Waits until `holds` returns true, for --wait seconds at most, but not for announcements that cannot
    // come any more (Offers::AreAllThere). Returns the last result of `holds`. `pattern`: the nodes whose
    // announcements matter.
    bool WaitForOffers(const std::string &pattern, const std::function<bool()> &holds);
    // After --wait seconds: waits for announcements that are still lacking, as a node may be answering
    // others, for 3 s at most, and not at all if --wait was given.
    void WaitForRest();
    // Makes WaitUntil ask `holds` again; any thread.
    void Notify() { _wakeup.Notify(); }
    // Seconds since the start of the session. Any thread.
    double Seconds() const;
    // True if a node was heard.
    bool IsAnybodyThere() const { return !_explorer->Nodes().empty(); }
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

}  // namespace Rabit::Tool
