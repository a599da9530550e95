#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include "VendorTraffic.h"
#include "common/DiscoveryOutbox.h"
#include "common/DiscoveryPace.h"
#include "common/KeyExchangeOutbox.h"

namespace Rabit::Cyclone
{

// A thread that sends what a DiscoveryOutbox and a KeyExchangeOutbox let go.
class OutboxThread
{
public:
    // Called on the thread. `route` is one that was given to Put.
    using Send = std::function<void(const RabitCycloneRoute &route, bool toGroup,
                                    std::span<const std::uint8_t> datagram)>;

    OutboxThread(std::shared_ptr<DiscoveryPace> pace, Send send);
    ~OutboxThread();
    OutboxThread(const OutboxThread &) = delete;
    OutboxThread &operator=(const OutboxThread &) = delete;

    // Send is not called afterwards.
    void Stop();

    // All that follows: any thread, with the vendor's locks held.

    // From that socket announcements go to the group of discovery.
    void HasGroup(const void *connection);
    // The parts of a message; false if it is to go as it is. hears: who is there hears the group, too, if
    // there is one.
    bool Put(std::span<const std::uint8_t> message, std::vector<DiscoveryPart> parts,
             const RabitCycloneRoute &route, bool hears);
    // A datagram of an exchange of keys; false if it is to go as it is. What may go now is sent on this
    // thread.
    bool PutExchange(std::span<const std::uint8_t> datagram, const KeyExchange &what,
                     const RabitCycloneRoute &route);
    // One that came. False if the vendor should not see it.
    bool ReceivedExchange(const KeyExchange &what);
    // A message of discovery that came; it must be sound.
    void Received(std::span<const std::uint8_t> message);
    // So many bytes of discovery have gone past it.
    void Sent(std::size_t size);
    // The same, of an announcement.
    void Announced(std::span<const std::uint8_t> message);

private:
    using Clock = std::chrono::steady_clock;

    std::uint64_t NumberOf(const RabitCycloneRoute &route);
    std::optional<Clock::time_point> Due() const;
    void SendExchanges(std::unique_lock<std::mutex> &lock);
    void Run();

    const std::shared_ptr<DiscoveryPace> _pace;
    const Send _send;
    std::mutex _mutex;
    std::condition_variable _changed;
    DiscoveryOutbox _outbox;                 // guarded by _mutex
    KeyExchangeOutbox _exchanges;            // guarded by _mutex
    KeyExchange::Prefix _self{};             // once something was exchanged; guarded by _mutex
    std::vector<RabitCycloneRoute> _routes;  // by their numbers; guarded by _mutex
    std::set<const void *> _groups;          // of the sockets that have one; guarded by _mutex
    bool _stop = false;                      // guarded by _mutex
    std::thread _thread;
};

}  // namespace Rabit::Cyclone
