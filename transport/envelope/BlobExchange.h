#pragma once

#include <rabit/base/Backoff.h>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "envelope/BlobMessage.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Brings blobs (BlobMessage.h) from session to session: by need, by hash, in parts.
//
// - A session that lacks a blob asks the session that named it. It repeats the request at growing intervals,
//   and names the parts that it lacks. One datagram asks several sessions. All hear the answer, and a session
//   that hears a request of another one for the same blob postpones its own.
// - A part is sent again no sooner than 50 ms later, and later each time.
// - A bulletin is offered to the sessions that send in a former epoch: its first part goes in that epoch.
// They
//   ask for the others. A session that hears another one send it postpones its own offer.
// - A session that has not proven that it is live is sent no more bytes than came from it.
//
// A pure state machine. Time is passed in. Not thread-safe.
class BlobExchange
{
public:
    static constexpr std::chrono::milliseconds FirstRetry{60};
    static constexpr std::chrono::milliseconds QuickRetry{200};
    static constexpr std::chrono::seconds LongestRetry{10};
    static constexpr double RetryFactor = 1.2;
    static constexpr int QuickRetries = 24;
    // Each blob that is wanted takes its time on a thin channel: so long no request is repeated.
    static constexpr std::chrono::milliseconds AnswerTakes{10};
    static constexpr std::size_t MostAnswers = 32;
    // Certificates of several sessions come at one time, and are asked for in one datagram.
    static constexpr std::chrono::milliseconds Gather{30};
    // First requests of several sessions for one blob are spread over this time: one of them serves all.
    static constexpr std::chrono::milliseconds RequestSpread{60};
    static constexpr std::chrono::milliseconds Together{40};
    static constexpr std::chrono::milliseconds FirstPartGap{50};
    static constexpr std::chrono::milliseconds LongestPartGap{500};
    static constexpr double PartGapFactor = 2.0;
    // A request that comes so soon after the part has gone was sent before the part came.
    static constexpr std::chrono::milliseconds Crossing{40};
    // After this time without a request the gap is short again.
    static constexpr std::chrono::seconds Quiet{5};
    static constexpr std::chrono::milliseconds FirstOffer{300};
    static constexpr std::chrono::seconds LongestOffer{5};
    // Offers of several sessions are spread over this time.
    static constexpr std::chrono::milliseconds OfferSpread{200};
    // Others postpone an offer by at most this time.
    static constexpr std::chrono::seconds LongestPostponed{2};
    // A source that has sent nothing for this time is replaced by another one that has the blob. At the
    // slowest, a part and a claim take 1.9 s (SharedPace::LeastOfOne).
    static constexpr std::chrono::seconds SourcePatience{3};
    // So is a certificate that had its turn and did not bring the whole, by another certificate. The next one
    // has twice the time: the largest blob takes 14 s. One that was replaced waits twice as long for its next
    // turn. So a member that sends wrong parts, or sends them slowly, keeps a blob back for seconds alone.
    static constexpr std::chrono::milliseconds FirstTurn{3000};
    static constexpr std::chrono::milliseconds LongestTurn{60'000};
    static constexpr std::size_t MostTried = 8;
    // A blob that nobody named for this time is wanted no longer.
    static constexpr std::chrono::seconds Forgotten{10};
    // Of each BlobKind.
    static constexpr std::array<std::size_t, BlobKinds + 1> MostWanted{64, 16, 16};
    static constexpr std::size_t MostOffers = 8;  // epochs
    // Bytes of all incomplete blobs. If there are more, the largest one begins again.
    static constexpr std::size_t MostIncomplete = std::size_t{256} * 1024;
    static constexpr std::size_t MostCredit = 4096;

    // The session that a datagram came from, and the epoch in which it was sealed.
    struct Source
    {
        SessionTag Tag = 0;
        Epoch In = 0;
        Serial Number = 0;  // of its certificate
    };
    struct Blob
    {
        BlobKind Kind = BlobKind::Permissions;
        Hash Of{};
        std::vector<std::uint8_t> Bytes{};
    };

    // `self`: the tag of this session. `spread`: which share of the spreads this session waits, 0 to 255.
    BlobExchange(SessionTag self, const RtpsHeader &own, std::uint8_t spread)
        : _self(self), _own(own), _spread(spread)
    {
    }

    // Sets this session's own blob of that kind, in place of the former one.
    void SetOwn(BlobKind kind, const Hash &hash, std::shared_ptr<const std::vector<std::uint8_t>> bytes);

    // The session names a blob that this node lacks. Anybody can name a bulletin that does not exist, so
    // each certificate has one: the newest that its sessions name.
    void Want(BlobKind kind, const Hash &hash, const Source &from, TimePoint now);
    bool IsWanted(const Hash &hash) const { return _wanted.contains(hash); }
    // The blob is there, or is of no use.
    void Drop(const Hash &hash);
    // A proven session sends in that former epoch: the own bulletin is offered there.
    void Offer(Epoch in, TimePoint now);
    // So many bytes came from a session that is not proven.
    void Credit(std::size_t bytes);

    // Takes a message of another session. `isProven`: the sender is live. Returns the blob that it completes,
    // whose hash is right. A bulletin that another session offers has to be wanted first.
    std::optional<Blob> Received(const BlobMessage &message, const Source &from, bool isProven,
                                 TimePoint now);

    std::optional<TimePoint> Due() const;
    struct Outgoing
    {
        Epoch In = 0;
        std::vector<std::uint8_t> Message{};  // an RTPS message, to be sealed for all in the class Bulletin
    };
    // Bytes of the message that TakeDue would return now, without up to three of padding; 0: none is due.
    std::size_t DueBytes(TimePoint now);
    // Takes a message that is due; empty: none is.
    std::optional<Outgoing> TakeDue(TimePoint now);

    // Bytes of all incomplete blobs.
    std::size_t Incomplete() const { return _incomplete; }
    std::size_t Wanted() const { return _wanted.size(); }

private:
    struct Lack
    {
        BlobKind Kind = BlobKind::Permissions;
        Source From{};
        TimePoint Named{};     // when a session named it last
        TimePoint Progress{};  // when the source was chosen, or sent a part
        TimePoint Since{};     // when the turn of its certificate began
        std::chrono::milliseconds Turn = FirstTurn;
        std::set<Serial> Tried{};  // certificates that were replaced
        std::size_t Size = 0;      // 0: not known yet
        std::map<std::size_t, std::vector<std::uint8_t>> Parts{};
        std::size_t Bytes = 0;
        bool IsSpared = false;  // another session has asked for the same since this one did
        BackoffTimer<TimePoint> Retry{{FirstRetry, LongestRetry, RetryFactor, 0, QuickRetries, QuickRetry}};
    };
    struct OwnPart
    {
        bool IsWanted = false;
        Epoch In = 0;
        TimePoint SentAt{};
        TimePoint NotBefore{};
        TimePoint Asked{};
        Backoff Gap{{FirstPartGap, LongestPartGap, PartGapFactor}};
    };
    struct OwnBlob
    {
        Hash Of{};
        std::shared_ptr<const std::vector<std::uint8_t>> Bytes{};
        std::vector<OwnPart> Parts{};
    };
    struct Offered
    {
        TimePoint Heard{};
        TimePoint Latest{};  // others postpone it no longer
        BackoffTimer<TimePoint> Timer{{FirstOffer, LongestOffer}};
    };

    // This session's share of it.
    std::chrono::milliseconds ShareOf(std::chrono::milliseconds spread) const;
    static std::uint64_t LackingOf(const Lack &want);
    template <typename Is>
    void DropIf(const Is &is);
    void DropParts(Lack &want);
    static bool MayReplace(const Lack &lack, const Source &from, TimePoint now);
    void Replace(Lack &lack, const Source &from, TimePoint now);
    void Keep(const BlobPart &part, const Source &from, TimePoint now);
    std::optional<Blob> Complete(const Hash &hash, TimePoint now);
    void Take(const BlobRequest &request, const Source &from, bool isProven, TimePoint now);
    void WantPart(BlobKind kind, std::size_t index, Epoch in, TimePoint now);
    void MakeOffers(TimePoint now);
    struct DuePart
    {
        OwnPart *Of = nullptr;  // null: none is due
        BlobPart Content{};
    };
    DuePart NextPart(TimePoint now);
    std::optional<Epoch> RequestsIn(TimePoint now);
    static bool IsRequested(const Lack &lack, Epoch in, TimePoint now);
    std::optional<Outgoing> TakePart(TimePoint now);
    std::optional<Outgoing> TakeRequests(TimePoint now);

    const SessionTag _self;
    const RtpsHeader _own;
    const std::uint8_t _spread;
    std::array<OwnBlob, BlobKinds> _owned{};
    std::map<Hash, Lack> _wanted;
    std::map<Epoch, Offered> _offers;
    std::size_t _incomplete = 0;
    std::size_t _credit = 0;
};

}  // namespace Rabit::Envelope
