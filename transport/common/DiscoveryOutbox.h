#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/DiscoveryParts.h"

namespace Rabit
{

// What a session's discovery has to say of endpoints, between the vendor, which says it to each peer by
// itself and again until it is answered, and the air, where answers may be seconds under way.
//
// - A slot for each subject: what is new takes the place of what has not gone yet.
// - What has come together within Hold goes in one datagram, to all if it is for several who hear the group.
// - What is said again unchanged goes at growing distances, and not before an answer can be here: nobody
//   knows yet whether it was heard.
// - To who has not said anything before, or not for long, all is new that was said to all: it was not there.
//   The same holds for what was said to one alone before it knew us: it did not heed that.
// - Who does not hear the group hears an announcement of ours when its turn comes, often after we have heard
//   it. News for it wait until it has said something to us: it would not heed them before, and asks for them
//   then.
// - All together stays within a rate, in the order in which it came due, but that heartbeats and
//   acknowledgements, which are small and for which somebody waits, go before news that came due earlier, up
//   to a datagram's size between two datagrams of those. What discovery says beside (of participants) goes at
//   once, and what it takes of that is missing here. Where peers are listed an announcement goes to each of
//   their ports, most of which nobody has: of a rate that was not set, but learned, such a round takes no
//   more than one of them.
// - A session that has just begun may say at once what it has: nobody can know less of it, and what is said
//   once is needed whatever the rate. Not where a rate was set.
// - The rate follows how soon heartbeats are answered, as the air's delay tells its load (RFC 6817): a quick
//   answer raises it, a late one lowers it, but not twice for what went before it was lowered. Once the first
//   heartbeats were answered there are few; what a peer says of how late our datagrams come does the same.
// - Of who does not hear the group, and had never said anything to us when it was asked, the first answer is
//   quick if it is so after the last time that it was asked, and late only if it is so after our last
//   announcement, too. If it is neither, the next one counts.
//
// A pure state machine, not thread-safe; `now` never goes back by more than threads do.
class DiscoveryOutbox
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;

    static constexpr std::chrono::milliseconds Hold{10};
    // Of heartbeats and acknowledgements each distance is twice the one before, of news four times.
    static constexpr std::chrono::milliseconds FirstGap{100};
    static constexpr std::chrono::milliseconds FirstGapOfNews{200};
    static constexpr std::chrono::milliseconds LongestGap{4000};
    // What nobody wanted to say for so long is not said again, but anew.
    static constexpr std::chrono::milliseconds Rest{8000};
    static constexpr std::size_t MostSlots = 16384;
    // A subject that was not said for so long is forgotten, and so is a peer that said nothing for so long.
    // That is done whenever the number of subjects has doubled. Longer than leases.
    static constexpr std::chrono::minutes Forgotten{5};
    static constexpr std::size_t FewestToSweep = 64;
    // Bytes in a second, headers of IP and UDP included, and how many may go at once after a rest.
    static constexpr double FirstRate = 2000.0;
    static constexpr double LeastRate = 400.0;
    static constexpr double MostRate = 20000.0;
    static constexpr double Burst = 1500.0;
    static constexpr double FirstBurst = 6000.0;  // of a session that has just begun
    // Announcements that follow each other within that are of one round.
    static constexpr std::chrono::milliseconds Round{50};
    // Of answers. What is between quick and late changes nothing.
    static constexpr std::chrono::milliseconds Quick{100};
    static constexpr std::chrono::milliseconds Late{300};
    static constexpr double FirstRaise = 2.0;  // until it was lowered
    static constexpr double Raise = 1.25;
    static constexpr double Lower = 0.5;
    // Between two of each for what others say of the air.
    static constexpr std::chrono::milliseconds RaiseGap{500};
    static constexpr std::chrono::milliseconds LowerGap{1000};
    static constexpr std::size_t Headers = 20 + 8;  // IPv4, UDP
    // A datagram with several parts is not larger.
    static constexpr std::size_t LargestDatagram = 1100;
    static constexpr std::size_t SmallestDatagram = 300;

    // Which way a part has to go. Numbers are any that tell one from another.
    struct Route
    {
        std::uint64_t Address = 0;
        std::optional<std::uint64_t> Group;  // that who is there hears, too
    };
    struct Datagram
    {
        std::uint64_t Address = 0;  // of a route
        bool ToGroup = false;       // of that route
        std::vector<std::uint8_t> Bytes;
    };

    // What it may be at most; 0: as much as it finds.
    void SetRate(double most);
    double Rate() const { return std::min(_rate, _most); }
    // How long answers take.
    Duration AnswerTime() const { return _answerTime; }
    // `message`: the one that it was in. They all begin alike.
    void Put(std::span<const std::uint8_t> message, DiscoveryPart part, const Route &route, TimePoint now);
    // A peer says that a datagram of ours came so much later than the quickest.
    void CameLate(Duration delay, TimePoint now);
    // A message of somebody's that came; it must be sound.
    void Received(std::span<const std::uint8_t> message, TimePoint now);
    // So many bytes of discovery have gone past this.
    void Sent(std::size_t size, TimePoint now);
    // The same, of an announcement of our participant.
    void Announced(std::span<const std::uint8_t> message, TimePoint now);
    // When TakeDue has something.
    std::optional<TimePoint> Due() const;
    // Since when the next one has been held up, by now or later, because answers come late; empty: it is not.
    std::optional<TimePoint> HeldUpSince() const;
    // What is to go now.
    std::vector<Datagram> TakeDue(TimePoint now);
    // Subjects, or heartbeats that nobody has answered, whichever are more.
    std::size_t Size() const { return std::max(_slots.size(), _questions.size()); }

private:
    struct Key
    {
        bool ToGroup = false;
        std::uint64_t Way = 0;  // the group's number, or the address's
        DiscoveryPart::Subject About;
        auto operator<=>(const Key &) const = default;
    };
    struct Slot
    {
        DiscoveryPart Part;  // its bytes: of the last that came
        std::uint64_t Address = 0;
        bool Said = false;  // and then:
        std::uint64_t Content = 0;
        TimePoint SaidAt{};
        Duration Gap{0};
        TimePoint AskedAt{};
        std::optional<std::pair<TimePoint, std::uint64_t>> Due;  // if it has not gone; and its turn
    };
    using Slots = std::map<Key, Slot>;
    using Question = std::pair<DiscoveryPart::Prefix, DiscoveryPart::Entity>;  // to whom, of which writer
    struct Asked
    {
        TimePoint First;
        TimePoint Last;
        bool HeardUs = true;    // certainly, when it was asked
        bool Answered = false;  // in a way that says nothing of the time; counts anew if it is asked again
    };

    void PutHeader(std::span<const std::uint8_t> message);
    void ForgetRested(TimePoint now);
    void ForgetOld(TimePoint now);
    // When the rate lets the next one go.
    TimePoint Free() const;
    void Fill(TimePoint now);
    std::size_t Largest() const;
    Datagram Take(TimePoint now);
    void Go(Slots::iterator slot, TimePoint now);
    void Ask(const Question &question, bool alone, bool again, TimePoint now);
    void SetDue(Slots::iterator slot, TimePoint due);
    Duration FirstGapOf(const Slot &slot) const;
    // Somebody has said something, to whomever.
    void Heard(const DiscoveryPart::Prefix &peer, TimePoint now);
    // Somebody has said something to us.
    void KnowsUs(const DiscoveryPart::Prefix &peer, TimePoint now);
    Slots::iterator First(TimePoint now) const;
    void Answered(const Question &question, TimePoint now);
    void RaiseRate(TimePoint now);
    void LowerRate(TimePoint now);

    double _rate = FirstRate;
    double _most = MostRate;
    bool _isSet = false;
    TimePoint _raisedAt{};
    TimePoint _loweredAt{};
    Duration _answerTime{0};               // the longest, by half less with each that is shorter
    std::map<Question, Asked> _questions;  // that are not answered yet
    std::map<DiscoveryPart::Prefix, TimePoint> _knowUs;  // and when they last said something to us
    std::map<DiscoveryPart::Prefix, TimePoint> _heard;   // when they last said something
    std::optional<TimePoint> _announcedAt;               // last
    std::optional<TimePoint> _roundAt;                   // that was missing last
    double _left = FirstBurst;
    std::size_t _aheadOfNews = 0;  // bytes that have gone since before what had come due earlier
    TimePoint _filledAt{};
    std::array<std::uint8_t, 20> _header{};
    Slots _slots;
    std::map<std::pair<TimePoint, std::uint64_t>, Slots::iterator> _due;
    std::uint64_t _turn = 0;
    std::size_t _sweepAt = FewestToSweep;  // so many slots
};

}  // namespace Rabit
