#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/KeyExchange.h"
#include "guard/DiscoveryCheck.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Decides when to begin anew with a participant that was not authenticated. One forged announcement, or one
// damaged message of a handshake, keeps two honest participants apart for good: the vendors keep the first
// addresses of a participant, and do not try every failed handshake again. So a participant with which
// nothing has gone on for a while is forgotten, by the own vendor and by a goodbye to the participant itself.
// Both then begin with the next announcement.
//
// - An authenticated participant that goes on answering is never forgotten. The vendor is asked whether it is
//   one.
// - An authenticated participant that has lost this node begins anew without keys: by a request of a
//   handshake, or by a goodbye. Anybody can forge these, so the participant is asked for an answer that takes
//   the keys. If none comes, it is as one that was not authenticated. It is asked once in an attempt.
// - Until a participant is forgotten, the vendor sees no announcement of it with other content (addresses,
//   security). Those are the content that its handshake must confirm: see Signs.
// - Bounds: each attempt ends after a bounded number of steps, whatever a forger sends; attempts come with
//   exponential backoff; and only a participant that goes on announcing itself is tried again. A silent one
//   is the vendor's to forget.
//
// A pure state machine, not thread-safe.
class AuthenticationRetries
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Step = KeyExchange::Step;

    using Duration = std::chrono::steady_clock::duration;

    // Time without progress until an attempt has failed, if answers take no time: more than three times the
    // longest interval between repetitions (KeyExchangeOutbox::LongestGap). On a thin channel it is so many
    // answer times. Doubles with each attempt.
    static constexpr std::chrono::seconds Stalled{30};
    static constexpr int AnswerTimes = 16;
    // So many times as long if nothing has begun: the other side's requests wait for other exchanges.
    static constexpr int NotBegun = 3;
    static constexpr std::chrono::seconds Longest{300};
    // Datagrams of keys that count as progress in one attempt. A pair exchanges some twenty.
    static constexpr int MostKeys = 64;
    // As many as the guard knows (KnownPeers). When there are more, the one whose announcement came longest
    // ago is forgotten here.
    static constexpr std::size_t Most = 1024;

    // Content of a participant's announcement.
    struct Content
    {
        std::uint64_t Digest = 0;  // of addresses and security
        SignedContent Signed{};
        std::int64_t Number = 0;  // of the sample
    };

    // `forgetsSilent`: a participant that announces itself no more is forgotten, too. For a vendor that does
    // not heed the lease of one that is not authenticated, and would send to it for good. `stalled`: in place
    // of Stalled.
    explicit AuthenticationRetries(bool forgetsSilent = false, Duration stalled = Stalled)
        : _forgetsSilent(forgetsSilent), _stalled(stalled)
    {
    }

    // A participant was announced. Returns false if the vendor should not see that, because it knows the
    // participant with other content.
    bool Announced(const GuidPrefix &peer, const Content &content, TimePoint now);
    // A message of a handshake came that signs this content of its sender; empty: none. Returns false if the
    // vendor should not see it, because it knows the sender with other content. Only a participant whose
    // handshake confirms its announcement is authenticated, so that a forged announcement does not last.
    bool Signs(const GuidPrefix &peer, const SignedContent &content);
    // A message of that step was received from the participant, or sent to it. Of a handshake only the first
    // of each step in an attempt counts, and MostKeys datagrams of keys.
    void Exchanged(const GuidPrefix &peer, Step step, bool isSent, TimePoint now);
    // A goodbye without keys was received from the participant.
    void SaidGoodbye(const GuidPrefix &peer, TimePoint now);
    // The vendor does not know the participant any more.
    void Gone(const GuidPrefix &peer);

    // When a participant is to be asked, or may have to be forgotten, if answers take that long; none: no
    // time.
    std::optional<TimePoint> Due(Duration answerTime) const;
    // The participants to ask now for an answer that only an authenticated one can give. Each is returned
    // once.
    std::vector<GuidPrefix> TakeToAsk();
    // The participants to look at now. For each, one of the next three is to be called.
    std::vector<GuidPrefix> Doubtful(TimePoint now, Duration answerTime) const;
    void IsAuthenticated(const GuidPrefix &peer);
    // A message to it has not been sent yet: it gets more time.
    void IsWaiting(const GuidPrefix &peer, TimePoint now);
    // Returns the number for the goodbye that makes the vendor forget it.
    std::int64_t Forget(const GuidPrefix &peer);
    // True if it was forgotten in this way, and not announced since.
    bool WasForgotten(const GuidPrefix &peer) const;

private:
    struct Peer
    {
        Content Known;
        bool IsKnown = false;  // to the vendor; if not, Known is of the past
        bool IsForgotten = false;
        bool IsAuthenticated = false;
        bool IsToAsk = false;
        bool IsContradicted = false;  // since it is known
        std::uint32_t Steps = 0;      // of this attempt: a bit for each step, sent or received
        int Keys = 0;                 // datagrams in this attempt, up to MostKeys
        int Attempts = 0;             // that have failed
        TimePoint ProgressAt{};
        TimePoint AnnouncedAt{};
    };

    static void BeginsAnew(Peer &peer, TimePoint now);
    std::optional<TimePoint> DueOf(const Peer &peer, Duration answerTime) const;
    void MakeRoom();

    const bool _forgetsSilent;
    const Duration _stalled;
    std::map<GuidPrefix, Peer> _peers;
};

}  // namespace Rabit::Rtps
