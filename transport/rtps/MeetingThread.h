#pragma once

#include <rabit/transport/DiscoveryTurns.h>
#include <rabit/transport/Transport.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "common/DueThread.h"
#include "guard/PeerObserver.h"
#include "rtps/Meeting.h"

namespace Rabit::Rtps
{

// Runs a Meeting on a thread of its own, which does due work. Messages to the network wait for their turn
// (DiscoveryTurns.h) where the session's holder gives turns. Thread-safe.
class MeetingThread final : public DueThread, public PeerObserver, private DiscoveryTurns::Exchange
{
public:
    // Called without a lock of this object, on that thread; Send in a turn also on the holder's thread.
    struct Calls
    {
        // Sends to one participant, or to all if `to` is empty.
        std::function<void(const std::optional<GuidPrefix> &to, std::span<const std::uint8_t> datagram)> Send;
        // Delivers a message to the own DDS implementation, as if it came from that address.
        std::function<void(const HostAddress &from, std::span<std::uint8_t> datagram)> Deliver;
        // When the participant was last heard; empty: it is not known.
        std::function<std::optional<Clock::time_point>(const GuidPrefix &)> LastHeard;
    };

    MeetingThread(const Meeting::Settings &settings, std::shared_ptr<DiscoveryTurns> turns)
        : _meeting(settings), _turns(std::move(turns))
    {
    }
    ~MeetingThread() override { Stop(); }

    void Start(Calls calls);
    // When this returns, no call is in progress and none will be made. A call must not stop the thread.
    void Stop();

    // Forwarded to Meeting. Any thread; no call is made inside.
    void SetSelf(const GuidPrefix &self);
    bool IsSelf(const GuidPrefix &participant) const;
    bool Sending(std::span<const std::uint8_t> datagram);
    bool Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt);
    // The implementation has lost the participant.
    void Lost(const GuidPrefix &peer);
    bool WasEnded(const GuidPrefix &peer) const;
    // Meeting::CardIsFull, as a problem of the network. Any thread.
    std::optional<SettingsProblem> Problem() const;

    // PeerObserver
    void HeardUnknown(const GuidPrefix &peer) override;
    void Announced(const GuidPrefix &peer, bool hasCard) override;
    void Gone(const GuidPrefix &peer) override;
    void Spoke(const GuidPrefix &peer) override;
    bool IsReplayed(const GuidPrefix &peer) const override;

private:
    static constexpr std::chrono::seconds LookForSilent{1};

    // DiscoveryTurns::Exchange
    std::size_t NextBytes() override;
    void SendNext() override;
    std::chrono::nanoseconds QueueingDelay() const override;

    template <typename Task>
    auto With(const Task &task);
    std::optional<Clock::time_point> Due() override;
    void Work(std::unique_lock<std::mutex> &lock) override;
    void EndSilent();

    Meeting _meeting;             // guarded by _mutex
    Clock::time_point _lookAt{};  // for silent participants, if any is endable; guarded by _mutex
    Calls _calls;
    const std::shared_ptr<DiscoveryTurns> _turns;
};

}  // namespace Rabit::Rtps
