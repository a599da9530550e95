#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/KeyExchange.h"
#include "common/KeyExchangeStamp.h"
#include "common/RecentMap.h"

namespace Rabit
{

// Schedules a session's datagrams to participants with keys until both sides can read each other. Stands
// between the vendor and the network. The exchange takes 30 to 40 kB for each pair. The vendors send to all
// peers at once, and repeat each handshake message every second until it is answered. On a radio these
// repetitions fill the channel, answers queue behind them for longer than that, and no exchange ever
// completes. Where datagrams are lost, each lost one costs a second.
//
// - A window bounds the unanswered bytes to all peers together. Quick answers enlarge it, late ones halve it.
//   A missing answer does neither: loss is no sign of a full channel, delay is.
// - Messages that end an exchange go before those that begin one, in the order of KeyExchange::Step; within a
//   step, the longest waiting goes first. The last message of a handshake, and control, do not wait for the
//   window.
// - One exchange after the other: a request waits until no handshake with another peer has made progress for
//   Calm answer times. It waits no longer than LongestCalm after the first request to another peer, and in
//   all no longer than LongestWait. The more exchanges are under way at once, the longer each lasts, and all
//   that time the vendors repeat control.
// - The newest handshake message to a peer is repeated, with the same number, so that a receiver can collect
//   its fragments. It is repeated when an answer had time to arrive, with exponential backoff. It is dropped
//   when the peer has shown not to need it any more, or the vendor has not sent it for LongestSilence.
// - Keys keep their order and are dropped only beyond MostWaiting bytes. Control of each kind has one slot:
//   the newest goes, with exponential backoff, which is reset when keys come or go. A writer's control stays
//   behind its keys. Control about keys goes before other control. All control to a peer together may take
//   ControlShare of the other bytes that go to it; beyond this, one datagram goes in each interval.
// - A request for keys that are under way, or may be, is ignored: the vendors would send all of them again
//   each time. The peer repeats the request.
// - Datagrams protected as a whole are scheduled in the same way if they are for a peer with a recent
//   exchange. So is control of this kind to all peers, since the vendors repeat it too quickly as well.
//   Otherwise they are sent unchanged.
// - The last message of a handshake answers the peer's certificate (Step::Reply), each time that it comes.
//   It goes FinalDelay after the certificate: Fast DDS does not listen while it sends its certificate, and
//   never a second time to the same message. Its repetitions have intervals as those of other messages.
// - Datagrams of idle endpoints are dropped: the vendors would request data from each other that never comes.
// - A rate limits all of this, if one is set.
//
// The vendors repair datagrams dropped here as if the network had lost them. A pure state machine, not
// thread-safe; `now` may go back only as far as the clock readings of threads that compete for the lock.
class KeyExchangeOutbox
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;
    using Milliseconds = std::chrono::milliseconds;

    // Bytes, headers of IP and UDP included.
    static constexpr std::size_t FirstWindow = 9000;
    static constexpr std::size_t SmallestWindow = 5000;
    static constexpr std::size_t LargestWindow = 16000;
    // Bounds of the answer time: Quick answers enlarge the window, Late ones halve it.
    static constexpr Milliseconds Quick{200};
    static constexpr Milliseconds Late{1000};
    // Longer answer times, and stamps that came longer ago, are not taken for true.
    static constexpr Milliseconds LongestAnswer{20000};
    // An answer time consists of times that three clock readings have cut to whole milliseconds.
    static constexpr Milliseconds Rounding{2};
    // Interval between a message and its repetition: twice the answer time, within these bounds, and FirstGap
    // before one is known. Later intervals grow by half, up to LongestGap if answers do not take longer.
    static constexpr Milliseconds FirstGap{100};
    static constexpr Milliseconds ShortestGap{50};
    static constexpr Milliseconds LongestFirstGap{4000};
    static constexpr Milliseconds LongestGap{1000};
    // The vendors repeat a message every second, as long as they want an answer.
    static constexpr Milliseconds LongestSilence{2000};
    // The same for control, with intervals that double: from twice the answer time up to four times.
    static constexpr Milliseconds FirstControlGap{50};
    static constexpr Milliseconds ShortestControlGap{20};
    static constexpr Milliseconds LongestFirstControlGap{2000};
    static constexpr Milliseconds ShortestLongControlGap{200};
    static constexpr Milliseconds LongestControlGap{4000};
    static constexpr double ControlShare = 0.25;
    // Bytes of control that may go before any others, or after a pause.
    static constexpr double MostControlAhead = 2000.0;
    static constexpr Milliseconds FinalDelay{20};
    static constexpr int Calm = 4;
    static constexpr Milliseconds LongestCalm{3000};
    static constexpr Milliseconds LongestWait{15000};
    // Time after the last handshake or key until an exchange counts as settled.
    static constexpr Milliseconds Settled{6000};
    static constexpr std::size_t Headers = 20 + 8;  // IPv4, UDP
    static constexpr std::size_t MostPeers = 1024;
    static constexpr std::size_t MostControls = 64;        // of a peer
    static constexpr std::size_t MostDatagrams = 64;       // of a message of a handshake
    static constexpr std::size_t MostWaiting = 4'000'000;  // bytes, of keys

    struct Datagram
    {
        std::uint64_t Route = 0;
        std::vector<std::uint8_t> Bytes;
    };

    // Limits the rate to `most` bytes per second; 0: unlimited.
    void SetRate(double most) { _most = most; }
    // Takes a datagram that the vendor wants to send; `route` is any number, returned by TakeDue. Returns
    // false if the datagram was not taken and should be sent unchanged.
    bool Put(std::span<const std::uint8_t> datagram, const KeyExchange &what, std::uint64_t route,
             TimePoint now);
    // Notes a datagram that arrived for us. Returns false if the vendor should not see it.
    bool Received(const KeyExchange &what, TimePoint now);
    // Notes the end of a datagram that arrived for us, also of a fragment. Anyone can forge a stamp. So its
    // echo counts only if an exchange with the sender has not settled. It counts up to the time since the
    // first stamp that went to the sender in this exchange.
    void Stamped(const KeyExchange::Prefix &from, const KeyExchangeStamp &stamp, TimePoint now);
    // Time at which to call TakeDue; none: nothing waits.
    std::optional<TimePoint> Due() const;
    // Returns the datagrams to send now.
    std::vector<Datagram> TakeDue(TimePoint now);

    // True if a message of the handshake with that peer waits that is not a repetition of the last one.
    bool IsWaiting(const KeyExchange::Prefix &peer) const;
    // Drops all that waits for a peer: the exchange begins anew.
    void Forget(const KeyExchange::Prefix &peer);

    // How long peers take to answer; zero: unknown, also once all exchanges have settled.
    Duration AnswerTime(TimePoint now) const
    {
        return now - _exchangedAt < Settled ? _answerTime.value_or(Duration(0)) : Duration(0);
    }
    // Time at which all exchanges so far count as settled; it may be past.
    TimePoint SettledAt() const { return _exchangedAt + Settled; }
    std::size_t Window() const { return _window; }
    // Bytes that are sent and not answered.
    std::size_t Unanswered() const { return _unanswered; }
    std::size_t Peers() const { return _peers.size(); }

private:
    using Step = KeyExchange::Step;
    using Turn = std::uint64_t;
    struct Message  // of a handshake
    {
        Step What = Step::Request;
        std::uint64_t Number = 0;
        std::vector<Datagram> Datagrams;
        TimePoint Since;  // when a message began to wait, which newer ones have replaced since
        TimePoint PutAt;  // when the vendor sent it
        TimePoint Due;
        Turn Place = 0;
    };
    struct ControlKind
    {
        std::uint64_t Route = 0;
        std::uint32_t Source = 0;
        std::size_t Size = 0;
        auto operator<=>(const ControlKind &) const = default;
    };
    struct Control
    {
        std::vector<std::uint8_t> Bytes;  // waiting; empty: none
        bool IsWhole = false;             // KeyExchange::IsWhole
        bool IsSaid = false;              // if true, the next two are valid
        TimePoint SaidAt;
        Duration Gap{0};  // until the next one
        TimePoint Due;    // of the waiting datagram
        Turn Place = 0;
    };
    struct Keys
    {
        Datagram What;
        std::uint32_t Source = 0;
        bool IsWhole = false;  // KeyExchange::IsWhole
        TimePoint Since{};
        Turn Place = 0;
    };
    struct Peer
    {
        std::optional<Message> Waiting;  // to be sent, or sent and to be repeated
        std::optional<Step> Said;        // handshake step sent last; if set, then:
        std::uint64_t SaidNumber = 0;
        std::vector<Datagram> SaidFinal;  // to be repeated, if Said is Final
        TimePoint SaidAgainAt;            // no repetition before this
        Duration Gap{0};                  // interval until SaidAgainAt, and between later ones
        std::deque<Datagram> Rest;        // later fragments of the message sent last
        std::deque<Keys> KeysWaiting;
        TimePoint KeysSaidAt{};
        std::map<ControlKind, Control> Controls;
        double ControlAhead = MostControlAhead;  // bytes of control that may go now
        TimePoint ControlSaidAt{};
        std::size_t Unanswered = 0;  // bytes
        TimePoint UnansweredUntil;   // if there are any: after this they count as lost
        TimePoint TouchedAt;
        TimePoint ExchangedAt;
        std::optional<TimePoint> StampedAt;  // when the first stamp of this exchange went
        TimePoint HandshakeAt{};             // when a handshake with it last made progress
    };
    struct Choice
    {
        Step What = Step::Rest;
        bool IsWhole = false;  // of control
        Turn Place = 0;
        TimePoint Due;
        KeyExchange::Prefix Of{};
        std::optional<ControlKind> Kind;
    };

    Peer &PeerOf(const KeyExchange::Prefix &name, TimePoint now);
    void ForgetOldest();
    void Forget(std::map<KeyExchange::Prefix, Peer>::iterator peer);
    // True if a datagram that is protected as a whole must wait.
    bool IsHeld(const KeyExchange &what, TimePoint now) const;
    void Exchanged(Peer &peer, TimePoint now);
    bool Fits(std::size_t size) const { return _unanswered == 0 || _unanswered + size <= _window; }
    static std::size_t SizeOf(const Message &message);
    static bool IsBehindKeys(const Peer &peer, const ControlKind &kind);
    // The two peers whose handshakes made progress last.
    struct LastProgress
    {
        const Peer *Of = nullptr;
        TimePoint At{};
        TimePoint NextAt{};
    };
    LastProgress FindLastProgress() const;
    TimePoint DueOf(const Peer &peer, const LastProgress &last) const;
    bool IsBeyondShare(const Peer &peer, const Control &control) const;
    template <typename Visit>
    void VisitChoices(const Visit &visit) const;
    std::optional<Choice> Next(TimePoint now) const;
    void PutHandshake(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now);
    void PutControl(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now);
    void Take(const Choice &choice, TimePoint now, std::vector<Datagram> &taken);
    void TakeMessage(Peer &peer, TimePoint now, std::vector<Datagram> &taken);
    void Charge(Peer &peer, std::size_t size, bool waits, TimePoint now);
    struct Heard
    {
        std::uint32_t SentAt = 0;
        TimePoint At;
    };
    KeyExchangeStamp StampFor(const KeyExchange::Prefix &peer, TimePoint now) const;
    void Settle(Peer &peer) { _unanswered -= std::exchange(peer.Unanswered, 0); }
    void ForgetAnswersIfSettled(TimePoint now);
    void Expire(TimePoint now);
    void Lower(TimePoint now);
    Duration GapNow() const;
    Duration ControlGapNow() const;
    Duration LongControlGapNow() const;
    void BeginControlAnew(Peer &peer);

    double _most = 0.0;
    TimePoint _freeAt{};  // when the rate allows the next datagram
    std::size_t _window = FirstWindow;
    std::size_t _unanswered = 0;
    std::size_t _waiting = 0;             // bytes of keys
    std::optional<Duration> _answerTime;  // the longest; each shorter one halves it at most
    TimePoint _loweredAt{};
    TimePoint _exchangedAt{};  // with any peer
    TimePoint _requestedAt{};  // when a first request went to any peer
    std::map<KeyExchange::Prefix, Peer> _peers;
    RecentMap<KeyExchange::Prefix, Heard> _heard{MostPeers};
    Turn _turn = 0;
};

}  // namespace Rabit
