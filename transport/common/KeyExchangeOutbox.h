#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/KeyExchange.h"

namespace Rabit
{

// What a session says to participants with keys until they can read each other, between the vendor and the
// air. That is 30 to 40 kB for each pair of two; the vendors say it to all at once, and repeat each message
// of a handshake twice a second, or every second, until it is answered. On a radio the repetitions then fill
// the air, the answers wait behind them for longer than that, and nobody ever finds anybody.
//
// - What is said and not answered, to all together, is bounded by a window. It grows with what is answered
//   soon, and is halved by what is answered late or not at all.
// - What ends an exchange goes before what begins one, in the order of KeyExchange::Step; within that, what
//   has waited longest. The last message of a handshake, and control, do not wait for the window.
// - Of a handshake's messages to a peer only the newest waits. What the peer has shown that it does not need
//   any more is forgotten. The same one again goes when an answer had time to be here, at doubling distances.
// - Keys are never left out, and stay in their order. Control of the same kind has a slot: the newest goes,
//   at doubling distances, which begin anew when keys come or go. What a writer says of its keys stays behind
//   them.
// - Who asks for keys that are on their way, or may be, is not heard: the vendors would say all of them again
//   each time. It asks again.
// - The same holds for what is protected as a whole, to a peer with which something of all that was exchanged
//   a short while ago, and for control of that to all: the vendors say that in haste, too. Else it goes as it
//   is. Of endpoints that say nothing, always.
// - A rate bounds it all, if one is set.
//
// The vendors repair what is lost here as if the air had lost it. A pure state machine, not thread-safe;
// `now` never goes back by more than threads do.
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
    // Of answers. What is between them changes nothing.
    static constexpr Milliseconds Quick{200};
    static constexpr Milliseconds Late{1000};
    // Between a message and its repetition: four times as long as answers take, within these bounds.
    static constexpr Milliseconds FirstGap{500};
    static constexpr Milliseconds ShortestGap{250};
    static constexpr Milliseconds LongestFirstGap{4000};
    static constexpr Milliseconds LongestGap{8000};
    // The same of control, of which each distance is twice the one before: twice as long as answers take at
    // first, and then four times.
    static constexpr Milliseconds ShortestControlGap{50};
    static constexpr Milliseconds LongestFirstControlGap{1000};
    static constexpr Milliseconds ShortestLongControlGap{200};
    static constexpr Milliseconds LongestControlGap{1000};
    static constexpr Milliseconds LongestIdleGap{4000};  // KeyExchange::IsIdle
    // After the last handshake or key.
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

    // Bytes in a second; 0: unbounded.
    void SetRate(double most) { _most = most; }
    // One that the vendor wants to send; `route` is any number. False if it names nobody and is to go as it
    // is.
    bool Put(std::span<const std::uint8_t> datagram, const KeyExchange &what, std::uint64_t route,
             TimePoint now);
    // One that came, to us. False if the vendor should not see it.
    bool Received(const KeyExchange &what, TimePoint now);
    // When TakeDue has something.
    std::optional<TimePoint> Due() const;
    // What is to go now.
    std::vector<Datagram> TakeDue(TimePoint now);

    std::size_t Window() const { return _window; }
    // Bytes that are said and not answered.
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
        std::vector<std::uint8_t> Bytes;  // that waits; empty: none
        bool IsIdle = false;
        bool IsSaid = false;  // and then:
        TimePoint SaidAt;
        Duration Gap{0};  // until the next one
        TimePoint Due;    // of what waits
        Turn Place = 0;
    };
    struct Keys
    {
        Datagram What;
        std::uint32_t Source = 0;
        TimePoint Since{};
        Turn Place = 0;
    };
    struct Peer
    {
        std::optional<Message> Waiting;
        std::optional<Step> Said;  // of the handshake, last; and then:
        std::uint64_t SaidNumber = 0;
        TimePoint SaidAgainAt;      // not before
        Duration Gap{0};            // until that, and between later ones
        std::deque<Datagram> Rest;  // of the message that was said last
        std::deque<Keys> KeysWaiting;
        TimePoint KeysSaidAt{};
        std::map<ControlKind, Control> Controls;
        std::size_t Unanswered = 0;  // bytes; and then:
        TimePoint UnansweredSince;
        TimePoint UnansweredUntil;  // then they count as lost
        bool IsRepeated = false;    // one of them, so that an answer tells no time
        TimePoint TouchedAt;
        TimePoint ExchangedAt;
    };
    struct Choice
    {
        Step What = Step::Rest;
        Turn Place = 0;
        TimePoint Due;
        KeyExchange::Prefix Of{};
        std::optional<ControlKind> Kind;
    };

    Peer &PeerOf(const KeyExchange::Prefix &name, TimePoint now);
    void ForgetOldest();
    // Whether what is protected as a whole waits.
    bool IsHeld(const KeyExchange &what, TimePoint now) const;
    void Exchanged(Peer &peer, TimePoint now);
    bool Fits(std::size_t size) const { return _unanswered == 0 || _unanswered + size <= _window; }
    static std::size_t SizeOf(const Message &message);
    static bool IsBehindKeys(const Peer &peer, const ControlKind &kind);
    template <typename Visit>
    void VisitChoices(const Visit &visit) const;
    std::optional<Choice> Next(TimePoint now) const;
    void PutHandshake(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now);
    void PutControl(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now);
    void Take(const Choice &choice, TimePoint now, std::vector<Datagram> &taken);
    void TakeMessage(Peer &peer, TimePoint now, std::vector<Datagram> &taken);
    void Charge(Peer &peer, std::size_t size, bool waits, TimePoint now);
    // `tellsTime`: by what would not have been said but for what it answers.
    void Answered(Peer &peer, bool tellsTime, TimePoint now);
    void Expire(TimePoint now);
    void Lower(TimePoint now);
    Duration GapNow() const;
    Duration ControlGapNow() const;
    Duration LongControlGapNow() const;
    void BeginControlAnew(Peer &peer);

    double _most = 0.0;
    TimePoint _freeAt{};  // by the rate
    std::size_t _window = FirstWindow;
    std::size_t _unanswered = 0;
    std::size_t _waiting = 0;             // bytes of keys
    std::optional<Duration> _answerTime;  // the longest, by half less with each that is shorter
    TimePoint _loweredAt{};
    TimePoint _exchangedAt{};  // with anybody
    std::map<KeyExchange::Prefix, Peer> _peers;
    Turn _turn = 0;
};

}  // namespace Rabit
