#pragma once

#include <rabit/transport/DiscoveryTurns.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "RouteOrder.h"
#include "VendorTraffic.h"
#include "common/KeyExchangeOutbox.h"
#include "common/RecentNumbers.h"

namespace Rabit::Cyclone
{

// A thread that sends the datagrams that a KeyExchangeOutbox releases.
class OutboxThread
{
public:
    // Called on the thread. `route` is one that was passed to PutExchange.
    using Send = std::function<void(const RabitCycloneRoute &route, std::span<const std::uint8_t> datagram)>;

    OutboxThread(std::shared_ptr<DiscoveryTurns> turns, Send send);
    ~OutboxThread();
    OutboxThread(const OutboxThread &) = delete;
    OutboxThread &operator=(const OutboxThread &) = delete;

    // Send is not called after this.
    void Stop();

    // The functions below: any thread, with the vendor's locks held.

    // Takes a datagram of a key exchange. Returns false if it should be sent unchanged. Datagrams that may go
    // now are sent on the calling thread.
    bool PutExchange(std::span<const std::uint8_t> datagram, const KeyExchange &what,
                     const RabitCycloneRoute &route);
    // Takes a received datagram. Returns false if the vendor should not see it.
    bool ReceivedExchange(const KeyExchange &what);
    // As in KeyExchangeOutbox.
    bool IsWaiting(const KeyExchange::Prefix &peer);
    void Forget(const KeyExchange::Prefix &peer);

private:
    using Clock = std::chrono::steady_clock;

    void SendExchanges(std::unique_lock<std::mutex> &lock);
    void Run();

    const std::shared_ptr<DiscoveryTurns> _turns;
    const Send _send;
    std::mutex _mutex;
    std::condition_variable _changed;
    KeyExchangeOutbox _exchanges;  // guarded by _mutex
    KeyExchange::Prefix _self{};   // known once something was exchanged; guarded by _mutex
    RecentNumbers<RabitCycloneRoute, RouteOrder> _routes;  // guarded by _mutex
    bool _stop = false;                                    // guarded by _mutex
    std::thread _thread;
};

}  // namespace Rabit::Cyclone
