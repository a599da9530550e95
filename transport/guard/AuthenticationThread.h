#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "common/DueThread.h"
#include "guard/AuthenticationRetries.h"

namespace Rabit::Rtps
{

// Runs AuthenticationRetries on a thread of its own, which forgets participants. Thread-safe.
class AuthenticationThread final : public DueThread
{
public:
    // Called on that thread if nothing else is said, and without a lock of this object.
    struct Calls
    {
        // True if this node and the participant can read each other's discovery, and the participant has
        // answered since Ask.
        std::function<bool(const GuidPrefix &)> IsAuthenticated;
        // Asks an authenticated participant for an answer that it can give only with its keys. Null: the
        // vendor itself forgets an authenticated participant that begins anew.
        std::function<void(const GuidPrefix &)> Ask;
        // True if a message of the handshake with it waits to be sent for the first time.
        std::function<bool(const GuidPrefix &)> IsWaiting;
        // How long participants take to answer (KeyExchangeOutbox).
        std::function<Clock::duration()> AnswerTime;
        // Makes the vendor forget the participant, and the participant this node. `number`: of the goodbye.
        std::function<void(const GuidPrefix &, std::int64_t number)> Forget;
        // Drops all that waits to be sent to the participant. Called in Gone.
        std::function<void(const GuidPrefix &)> Drop;
    };

    // As AuthenticationRetries.
    explicit AuthenticationThread(bool forgetsSilent = false,
                                  AuthenticationRetries::Duration stalled = AuthenticationRetries::Stalled)
        : _retries(forgetsSilent, stalled),
          _lookEvery(std::min<Clock::duration>(stalled, LongestBetweenLooks))
    {
    }
    ~AuthenticationThread() { Stop(); }

    // No call is made after Stop, except in a Gone that has begun, and no call may stop the thread.
    void Start(Calls calls);

    // Forwarded to AuthenticationRetries. Any thread; no call is made inside, except in Gone.
    bool Announced(const GuidPrefix &peer, const AuthenticationRetries::Content &content);
    bool Signs(const GuidPrefix &peer, const SignedContent &content);
    void Received(const KeyExchange &what) { Exchanged(what.From, what, false); }
    void Sent(const KeyExchange &what) { Exchanged(what.To, what, true); }
    void Gone(const GuidPrefix &peer);
    void SaidGoodbye(const GuidPrefix &peer);
    bool WasForgotten(const GuidPrefix &peer) const;

private:
    static constexpr std::chrono::seconds LongestBetweenLooks{1};

    void Exchanged(const GuidPrefix &peer, const KeyExchange &what, bool isSent);
    void Noted();
    std::optional<Clock::time_point> Due() override { return _lookAt; }
    void Work(std::unique_lock<std::mutex> &lock) override;
    void LookAt(const GuidPrefix &peer, std::unique_lock<std::mutex> &lock);

    AuthenticationRetries _retries;  // guarded by _mutex
    const Clock::duration _lookEvery;
    std::optional<Clock::time_point> _lookAt;  // empty: nothing can become due; guarded by _mutex
    Calls _calls;
};

}  // namespace Rabit::Rtps
