#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rabit/transport/DiscoveryTurns.h>
#include <rabit/transport/FleetMember.h>

#include "common/DueThread.h"
#include "common/Ledger.h"
#include "envelope/Outer.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

class SealedCore;

// Seals and opens the datagrams of one session of a backend: of one opening or rejoining, on one path.
// Thread-safe: Seal and Open may be called on any threads at once, and wait for each other only while a
// peer's changed addresses are noted. No lock of this object is held while a function of Calls runs. A thread
// of its own introduces the session to other nodes, and brings them certificates, lists of permissions and
// bulletins (README.md, "How sessions are introduced"). These datagrams wait for their turn
// (DiscoveryTurns.h) where the session's holder gives turns.
class SealedSession final : private DueThread, private DiscoveryTurns::Exchange
{
public:
    struct Calls
    {
        // Sends a sealed datagram as it is, on this object's thread, or in a turn on the holder's: to one
        // place, or, if empty, to all by every way that the participant's announcements go (the group, and
        // peers that are listed or known). Must not call Start or Stop.
        std::function<void(const std::optional<Rtps::Place> &to, std::span<const std::uint8_t> sealed)> Send;
        // Takes a log line. Any thread; may be empty.
        std::function<void(const std::string &)> Log;
    };

    // The member must come from MakeFleetMember. `turns`: of the backend's session. Throws TransportError if
    // there is no thread for it, or if OpenSSL fails.
    explicit SealedSession(std::shared_ptr<FleetMember> member,
                           std::shared_ptr<DiscoveryTurns> turns = std::make_shared<DiscoveryTurns>());
    SealedSession(const SealedSession &) = delete;
    SealedSession &operator=(const SealedSession &) = delete;
    // Calls Stop.
    ~SealedSession();

    // `vendor`: the RTPS header with which the vendor's datagrams of this session begin: it is known once the
    // participant has its GUID prefix, at the latest with its first datagram. `own`: the header of datagrams
    // of our own (cards), with the same prefix; it may equal the other one. The first call alone has an
    // effect, and none during or after Stop. Any thread.
    void Start(const RtpsHeader &vendor, const RtpsHeader &own, Calls calls);
    bool IsStarted() const { return _isStarted.load(std::memory_order_acquire); }
    // When it returns, no function of Calls is running, and none will be called. Seal and Open go on. Any
    // number of times; not from inside of a function of Calls.
    void Stop();

    // Seals a whole RTPS message. `to`: the unicast place, or empty for a group. Pairwise if the place
    // belongs to exactly one proven session, else in group mode. Seal a message for each of its destinations
    // anew. Replaces `sealed`, and keeps its capacity. Returns false if nothing must be sent: before Start,
    // or because of a fault, which is counted, and is a problem of the member if it lasts.
    bool Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
              OuterClass contents, std::vector<std::uint8_t> &sealed);
    // Opens a datagram in place. Accepts any bytes. Returns the RTPS message for guard, cards and vendor, at
    // the beginning of `datagram`. Empty: there is nothing for them; also before Start.
    std::span<std::uint8_t> Open(std::span<std::uint8_t> datagram, const Rtps::Place &from, TimePoint now);

    // Where Calls::Send should also send, for nodes that do not hear the group and that the vendor may not
    // know. These are the places that they have announced. Port 0: a host of which nothing else is known.
    std::vector<Rtps::Place> Strangers(TimePoint now) const;

    // The name in the certificate of the proven session that speaks by this GUID prefix. Empty: there is none
    // such.
    std::optional<std::string> NameOf(const Rtps::GuidPrefix &peer) const;
    // True if that session's certificate allows it to write (or read) the topic, by its name in DDS. False as
    // long as its list of permissions has not come. The vendors' builtin topics are not asked for.
    bool MayWrite(const Rtps::GuidPrefix &peer, std::string_view topic) const;
    bool MayRead(const Rtps::GuidPrefix &peer, std::string_view topic) const;

    // The most bytes that sealing may add to a message.
    std::size_t MostAdded() const;

private:
    // Null if OpenSSL fails.
    std::unique_ptr<SealedCore> Made(std::vector<RtpsHeader> headers) const;
    std::optional<Clock::time_point> Due() override;
    void Work(std::unique_lock<std::mutex> &lock) override;
    // DiscoveryTurns::Exchange
    std::size_t NextBytes() override;
    void SendNext() override;
    // Introductions do not tell how long they waited.
    std::chrono::nanoseconds QueueingDelay() const override { return std::chrono::nanoseconds(0); }

    // Made by Start.
    std::unique_ptr<SealedCore> _core;
    Calls _calls;
    std::shared_ptr<FleetMember> _member;
    const std::shared_ptr<DiscoveryTurns> _turns;
    std::atomic<bool> _isStarted = false;
};

}  // namespace Rabit::Envelope
