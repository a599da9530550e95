#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "guard/PeerObserver.h"
#include "rtps/Meeting.h"

namespace Rabit::Rtps
{

// Runs a Meeting on a thread of its own, which does due work. Thread-safe.
class MeetingThread final : public PeerObserver
{
public:
    using Clock = std::chrono::steady_clock;

    // Called on that thread, without a lock.
    struct Calls
    {
        // Sends to one participant, or to all if `to` is empty.
        std::function<void(const std::optional<GuidPrefix> &to, std::span<const std::uint8_t> datagram)> Send;
        // Delivers a message to the own DDS implementation, as if it came from that address.
        std::function<void(const HostAddress &from, std::span<std::uint8_t> datagram)> Deliver;
        // When the participant was last heard; empty: it is not known.
        std::function<std::optional<Clock::time_point>(const GuidPrefix &)> LastHeard;
    };

    explicit MeetingThread(const Meeting::Settings &settings) : _meeting(settings) {}
    ~MeetingThread() override { Stop(); }

    void Start(Calls calls);
    // When this returns, no call is in progress and none will be made. A call must not stop the thread.
    void Stop();

    // Forwarded to Meeting. Any thread; no call is made inside. `rate`: bytes per second that the exchange
    // may take; 0: unlimited.
    bool Sending(std::span<const std::uint8_t> datagram, double rate);
    bool Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt);
    // The implementation has lost the participant.
    void Lost(const GuidPrefix &peer);
    bool WasEnded(const GuidPrefix &peer) const;

    // PeerObserver
    void HeardUnknown(const GuidPrefix &peer) override;
    void Announced(const GuidPrefix &peer, bool hasCard) override;
    void Gone(const GuidPrefix &peer) override;
    bool IsReplayed(const GuidPrefix &peer) const override;

private:
    static constexpr std::chrono::seconds LookForSilent{1};

    template <typename Work>
    auto With(const Work &work);
    void Run();
    void EndSilent();

    mutable std::mutex _mutex;
    std::condition_variable _changed;
    Meeting _meeting;                              // guarded by _mutex
    std::optional<Clock::time_point> _waitsUntil;  // guarded by _mutex
    bool _waits = false;                           // guarded by _mutex
    bool _stop = false;                            // guarded by _mutex
    Calls _calls;
    std::thread _thread;
};

}  // namespace Rabit::Rtps
