#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "guard/AuthenticationRetries.h"

namespace Rabit::Rtps
{

// Runs AuthenticationRetries on a thread of its own, which forgets participants. Thread-safe.
class AuthenticationThread
{
public:
    using Clock = std::chrono::steady_clock;

    // Called on that thread if nothing else is said, and without a lock of this object.
    struct Calls
    {
        // True if this node and the participant can read each other's discovery.
        std::function<bool(const GuidPrefix &)> IsAuthenticated;
        // True if a message of the handshake with it waits to be sent for the first time.
        std::function<bool(const GuidPrefix &)> IsWaiting;
        // How long participants take to answer (KeyExchangeOutbox).
        std::function<Clock::duration()> AnswerTime;
        // Makes the vendor forget the participant, and the participant this node. `number`: of the goodbye.
        std::function<void(const GuidPrefix &, std::int64_t number)> Forget;
        // Drops all that waits to be sent to the participant. Called in Gone.
        std::function<void(const GuidPrefix &)> Drop;
    };

    AuthenticationThread() = default;
    ~AuthenticationThread() { Stop(); }
    AuthenticationThread(const AuthenticationThread &) = delete;
    AuthenticationThread &operator=(const AuthenticationThread &) = delete;

    void Start(Calls calls);
    // When this returns, no call is in progress, except in Gone, and none will be made. No call may stop it.
    void Stop();

    // Forwarded to AuthenticationRetries. Any thread; no call is made inside, except in Gone.
    bool Announced(const GuidPrefix &peer, const AuthenticationRetries::Content &content);
    bool Signs(const GuidPrefix &peer, const std::vector<std::uint64_t> &addresses);
    void Received(const KeyExchange &what) { Exchanged(what.From, what, false); }
    void Sent(const KeyExchange &what) { Exchanged(what.To, what, true); }
    void Gone(const GuidPrefix &peer);
    bool WasForgotten(const GuidPrefix &peer) const;

private:
    void Exchanged(const GuidPrefix &peer, const KeyExchange &what, bool isSent);
    void Run();
    void LookAt(const GuidPrefix &peer, std::unique_lock<std::mutex> &lock);

    mutable std::mutex _mutex;
    std::condition_variable _changed;
    AuthenticationRetries _retries;  // guarded by _mutex
    bool _stop = false;              // guarded by _mutex
    bool _sleeps = false;            // until it is woken; guarded by _mutex
    Calls _calls;
    std::thread _thread;
};

}  // namespace Rabit::Rtps
