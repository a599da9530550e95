// The claims and the shared table of a node, for Python.
#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/SharedTable.h>

#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "Waitable.h"

namespace Rabit::Python
{

// Wakes threads and event loops of Python once a claim is decided, or lost. Its own functions may be called
// on any thread.
class ClaimWait
{
public:
    enum class Until
    {
        Decided,  // the node holds it, or does not want it any more
        Lost      // the node does not hold it
    };

    ClaimWait(const Claims &claims, std::string claim, Until until);

    bool IsReady() const;
    Waitable &Ready() { return *_ready; }
    // The node ends: the wait is ready from now on.
    void Close();

private:
    Claims _claims;
    const std::string _claim;
    const Until _until;
    const std::shared_ptr<Waitable> _ready = std::make_shared<Waitable>();
    RabitScopedConnection _connection;
    std::atomic<bool> _isClosed{false};
};

// Any thread, with the GIL or without it. A forked process is not the node: there Release has no effect,
// StatusOf and Mine return nothing, and no other function may be called.
class Agreement
{
public:
    // Throws ConfigError if the configuration has no `agreement`.
    explicit Agreement(GatewayConfig &config);

    // As Claims::Try if it is to ask once, else as Claims::Claim.
    bool Acquire(const std::string &claim, bool once);
    void Release(const std::string &claim);
    std::shared_ptr<ClaimWait> Wait(const std::string &claim, ClaimWait::Until until);
    Claims::Status StatusOf(const std::string &claim) const;
    std::vector<std::string> Mine() const;
    SharedTable &Table() { return _table; }
    // Calls the handler after each change of the claims and of the table.
    void ConnectChanged(const RabitHandler &handler);
    // The node ends: so do all waits.
    void Close();

private:
    bool IsForked() const { return getpid() != _process; }
    // The waits that Python still refers to. Needs the mutex.
    std::vector<std::shared_ptr<ClaimWait>> Waits();

    const pid_t _process = getpid();
    Claims _claims;
    SharedTable _table;
    std::mutex _mutex;
    std::vector<std::weak_ptr<ClaimWait>> _waits;  // guarded
    bool _isClosed = false;                        // guarded
};

}  // namespace Rabit::Python
