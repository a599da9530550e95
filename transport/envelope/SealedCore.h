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
#include <vector>

#include "common/HeardStrangers.h"
#include "common/Ledger.h"
#include "common/RecentMap.h"
#include "envelope/BlobExchange.h"
#include "envelope/BoundPeers.h"
#include "envelope/ClaimExchange.h"
#include "envelope/Member.h"
#include "envelope/NodeVoices.h"
#include "envelope/Opener.h"
#include "envelope/ProcessorBudget.h"
#include "envelope/SealingSide.h"
#include "envelope/SessionTable.h"
#include "envelope/SharedPace.h"

namespace Rabit::Envelope
{

// SealedSession without its thread and clock: seals and opens the datagrams of one session, and
// says which datagrams of its own are due. Time and random bytes are passed in. Thread-safe: sealing and
// opening have a lock each, and calls nothing while it holds one.
class SealedCore
{
public:
    // Fills all bytes at random; returns false if there are none. Any thread.
    using Random = std::function<bool(std::span<std::uint8_t>)>;

    static constexpr std::size_t MostLogs = 32;
    // Bulletins that wait to be learned. Further ones are asked for again.
    static constexpr std::size_t MostArrived = 2;
    // Sessions whose places for discovery data are known.
    static constexpr std::size_t MostFound = 1024;
    // Processor time in each second for rows about datagrams that anybody can send.
    static constexpr std::chrono::milliseconds RowsShare{10};
    // From one answer to calls (EpochOfCalls) to the next.
    static constexpr std::chrono::seconds BetweenAnswersToCalls{1};

    // Null if there are no random bytes, or if OpenSSL fails.
    static std::unique_ptr<SealedCore> Make(std::shared_ptr<Member> member, std::vector<RtpsHeader> headers,
                                            Random random, TimePoint now);
    SealedCore(const SealedCore &) = delete;
    SealedCore &operator=(const SealedCore &) = delete;

    // As those of SealedSession.
    bool Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
              OuterClass contents, std::vector<std::uint8_t> &sealed, TimePoint now);
    std::span<std::uint8_t> Open(std::span<std::uint8_t> datagram, const Rtps::Place &from, TimePoint now);
    std::shared_ptr<const BoundPeer> PeerOf(const Rtps::GuidPrefix &prefix) const
    {
        return _peers.Find(prefix);
    }

    // As that of SealedSession.
    std::vector<Rtps::Place> Strangers(TimePoint now);

    // True if Open has made something due since the last call.
    bool TakeIsNew() { return _isNew.exchange(false); }
    // When Learn or TakeLogs has work; when TakeDue has. Empty: never.
    std::optional<TimePoint> LocalDue() const;
    std::optional<TimePoint> NetworkDue() const;
    // Learns the bulletins that have arrived. May store one, and so wait for the disk.
    void Learn();
    std::vector<std::string> TakeLogs();
    // Bytes of the datagram that TakeDue would return now, with the headers of IP and UDP, but for padding;
    // 0: none is due.
    std::size_t DueBytes(TimePoint now);
    // Takes a sealed datagram that is due, for all; empty: none is.
    std::optional<std::vector<std::uint8_t>> TakeDue(TimePoint now);

    // For tests and counters.
    std::uint64_t Opened(OpenFault fault) const
    {
        const std::lock_guard lock(_mutex);
        return _opener.Count(fault);
    }
    struct Memory
    {
        std::size_t Sessions = 0;
        std::size_t Others = 0;  // entries of tables, and bytes of blobs
    };
    Memory Remembered() const;
    // True if datagrams of that session's prefix are opened now.
    bool IsOpenTo(const Rtps::GuidPrefix &prefix, TimePoint now) const;

private:
    SealedCore(std::shared_ptr<Member> member, Self self, VerifyingKey authority, Random random,
               TimePoint now);

    Nonce RandomNonce();
    // All below require _mutex.
    void FollowEpochs();
    void TakeFault(const Opener::Result &result, std::span<const std::uint8_t> datagram, const Outer &outer,
                   const Rtps::Place &from, TimePoint now);
    void AnswerCall(TimePoint now);
    void NoteRow(const Opener::Result &result, std::span<const std::uint8_t> datagram, const Outer &outer,
                 const Rtps::Place &from, TimePoint now);
    void TakeClaim(const Opener::Result &result, const Outer &outer, std::size_t size, TimePoint now);
    void TakeBlobs(std::span<const std::uint8_t> bytes, const Session &sender, const Outer &outer,
                   std::size_t size, TimePoint now);
    // Something has to be sent to the session, whose datagram came from there.
    void Await(SessionTag tag, const Rtps::Place &from, TimePoint now);
    void Ask(const Session *session, SessionTag tag, Epoch in, TimePoint now);
    bool IsReady(const Session &session, const BlobExchange::Source &from, TimePoint now);
    void Listen(const Session &sender, SessionTag tag, TimePoint now);
    void Refused(const Opener::Result &result);
    void Log(std::string line);

    const std::shared_ptr<Member> _member;
    const Random _random;
    Self _self;

    mutable std::mutex _mutex;  // of opening; locked before those of the objects below
    VerifyingKey _authority;
    std::uint64_t _version = 0;
    EpochSecrets _epochs;
    SessionTable _sessions;
    ClaimExchange _claims;
    Opener _opener;
    BlobExchange _blobs;
    SharedPace _pace;
    bool _isBlobNext = false;  // a claim was sent last
    NodeVoices _voices;
    ProcessorBudget _rows{RowsShare, ProcessorBudget::Reaction};
    TimePoint _callsFrom{};                                    // calls before are not answered
    RecentMap<SessionTag, AnnouncedPlaces> _found{MostFound};  // of proven sessions
    Rtps::HeardStrangers _strangers;                           // nodes of which only the host is known
    Rtps::HeardStrangers _known;                               // nodes that have announced where they are
    std::vector<std::vector<std::uint8_t>> _arrived;           // bulletins, to be learned without the lock
    std::vector<std::string> _logs;
    std::atomic<bool> _isNew = true;

    // These have locks of their own.
    SealingSide _sealing;
    BoundPeers _peers;
};

}  // namespace Rabit::Envelope
