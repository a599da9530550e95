#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "rtps/CardMessage.h"
#include "rtps/QueueingDelay.h"

namespace Rabit::Rtps
{

// Brings the own card to all other nodes, and theirs to this node.
//
// - A card that has changed is sent to all, in parts. Its summary follows at growing intervals, and after
//   that once a period: a node that lacks the card, or parts of it, asks for them.
// - A newcomer whose card has come may know nothing of this node: the summary goes a few times more.
// - Any datagram of a participant that is not known is a reason to ask it for its card. One that never
//   answers is a program without a card, and is left alone until it is heard again.
// - An unanswered request is repeated after 50 ms at first, later after a second, and not before an
//   answer can have come. The same part is sent again no sooner than 50 ms later, and later each time:
//   one answer by multicast serves all who ask.
// - A request for the cards of several nodes goes to all, and so do its answers: a node that overhears such a
//   request postpones its own, once.
// - Each message says when it was sent, and each answer when the request was. While messages are late, the
//   channel is full: requests and answers wait in queues, and neither is repeated before the one before can
//   have come.
// - All of it keeps to a rate, whatever its holder allows.
//
// A pure state machine, not thread-safe.
class CardExchange
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = Backoff::Duration;

    static constexpr std::chrono::milliseconds FirstRetry{50};
    static constexpr std::chrono::milliseconds LongestRetry{1000};
    // The intervals grow slowly: loss alone does not show that the channel is full.
    static constexpr double GapFactor = 1.25;
    // The factor for a part that several nodes request: that all of them lost it is less likely than that it
    // waits in a queue.
    static constexpr double CrowdFactor = 2.0;
    // Delays: a request waits in one queue, its answer in another.
    static constexpr int DelaysOfAnAnswer = 2;
    // This many nodes that have not answered are a crowd: the intervals of requests double.
    static constexpr std::size_t Several = 3;
    // A repeated request that is due within this time goes in one datagram with one that is due now.
    static constexpr std::chrono::milliseconds Together{200};
    // Requests in vain to a participant that may have no card, and requests to one that has a card. Then
    // there is a rest, a short one for a participant that says that it has a card.
    static constexpr int MostVainRequests = 10;
    static constexpr int MostRequests = 30;
    static constexpr std::chrono::seconds Rest{5};
    static constexpr std::chrono::seconds ShortRest{1};
    // Most participants without a known card that are asked within a Rest: a forger can invent any number.
    static constexpr std::size_t MostUnknown = 16;
    // A message with an older summary than the wanted one is a repeat of somebody else. It is believed if the
    // wanted card has not come for this time.
    static constexpr std::chrono::seconds Believed{2};
    // From a card's summary to the first request: its parts may be on their way.
    static constexpr std::chrono::milliseconds Patience{30};
    static constexpr std::chrono::milliseconds FirstSummary{100};
    static constexpr std::chrono::milliseconds LongestSummary{2000};
    static constexpr double SummaryFactor = 1.5;
    // All of them are lost once in 100,000 times where 40 % of the datagrams are lost.
    static constexpr int InitialSummaries = 12;
    // For a newcomer, which may know nothing of this node.
    static constexpr int GreetingSummaries = 4;
    static constexpr std::chrono::milliseconds FirstAnswerGap{50};
    static constexpr std::chrono::milliseconds LongestAnswerGap{500};
    // After this time without a request the interval is short again.
    static constexpr std::chrono::seconds Quiet{5};
    static constexpr std::size_t MostPeers = 1024;
    // Bytes of all cards that are not complete. If there are more, the largest one begins again.
    static constexpr std::size_t MostIncomplete = 1024 * 1024;
    // Bytes per second, with the headers of IP and UDP, and the largest burst in bytes.
    static constexpr double Rate = 20000.0;
    static constexpr double Burst = 6000.0;
    static constexpr std::size_t IpAndUdp = 28;

    struct Settings
    {
        Duration Period{0};  // interval of the own card's summary
        // True if all messages go to all nodes. False: requests for one card, and their answers, go to one
        // node.
        bool IsMulticast = true;
    };

    explicit CardExchange(const Settings &settings) : _settings(settings) {}

    void SetSelf(const GuidPrefix &self) { _self = self; }
    // Sets the own card, packed (PackedCard.h).
    void SetOwn(std::vector<std::uint8_t> packed, TimePoint now);

    // A participant without a known card was heard.
    void Heard(const GuidPrefix &peer, TimePoint now);
    // A participant announced itself, and says that it has a card.
    void Announced(const GuidPrefix &peer, TimePoint now);
    struct Card
    {
        GuidPrefix Of{};
        std::vector<std::uint8_t> Packed;
    };
    // Takes a message of another node. Returns the packed card of the node if the message completes it.
    std::optional<Card> Received(const CardMessage &message, TimePoint now);
    // The card was not a valid one: it is requested again.
    void Refuse(const GuidPrefix &peer, TimePoint now);
    void Forget(const GuidPrefix &peer);

    std::optional<TimePoint> Due() const;
    struct Outgoing
    {
        std::optional<GuidPrefix> To;  // empty: all
        std::vector<std::uint8_t> Bytes;
    };
    // Takes one message that is due; empty: none is.
    std::optional<Outgoing> TakeDue(TimePoint now);
    // About how many bytes the next message that is due takes, with the headers of IP and UDP; 0: none is
    // due.
    std::size_t DueBytes(TimePoint now) const;
    // Current queueing delay of the other nodes' messages: their median; 0: none was heard lately.
    Duration Delay(TimePoint now) const;
    std::size_t Size() const { return _peers.size(); }

private:
    struct Peer
    {
        CardSummary Wanted;                                      // the card that the peer says it has
        std::uint32_t WantedAt = 0;                              // when it said so, by its clock
        TimePoint WantedSince{};                                 // by ours
        CardSummary Held;                                        // the card that is complete here
        std::map<std::size_t, std::vector<std::uint8_t>> Parts;  // of the wanted card
        std::size_t PartBytes = 0;
        BackoffTimer<TimePoint> Request{{FirstRetry, LongestRetry, GapFactor}};
        bool IsAnnounced = false;  // it has said that it has a card
        bool HasCard = false;      // a message of it has come
        int Asked = 0;             // requests since its last message
        TimePoint FirstAsked{};
        std::optional<TimePoint> LacksSince;  // first request for the missing parts
        TimePoint LastAsked{};
        bool IsSpared = false;  // another node has requested the same since LastAsked
        TimePoint Heard{};
        QueueingDelay Late;
    };
    struct OwnPart
    {
        bool IsWanted = false;
        std::optional<GuidPrefix> By;  // the only node that requests it; empty: several do, or none
        TimePoint NotBefore{};         // if it is wanted, its turn counts from here
        std::optional<TimePoint> SentAt{};
        std::optional<GuidPrefix> SentTo;  // empty: to all
        AnsweredRequest Answers{};         // its SentAt counts from the request's arrival
        Backoff Gap{{FirstAnswerGap, LongestAnswerGap, CrowdFactor}};
        TimePoint Asked{};
    };

    Peer *Find(const GuidPrefix &peer, TimePoint now);
    bool MakeRoom();
    static bool IsNews(const Peer &peer, const CardMessage &message, TimePoint now);
    void KeepPart(Peer &peer, const CardMessage &message);
    void DropParts(Peer &peer);
    bool MayAskUnknown(TimePoint now);
    void Ask(Peer &peer, TimePoint due, TimePoint now);
    bool Rests(const Peer &peer, TimePoint now) const;
    void Answered(Peer &peer, std::uint32_t sentAt, TimePoint now);
    static std::uint64_t LackingOf(const Peer &peer);
    void Take(const CardRequest &request, const CardMessage &message, TimePoint now);
    void Want(std::uint64_t parts, const std::optional<GuidPrefix> &by, const AnsweredRequest &request,
              TimePoint askedAt, TimePoint now);
    std::optional<GuidPrefix> Only(const GuidPrefix &peer) const;
    std::optional<TimePoint> RequestDue() const;
    std::optional<TimePoint> PartDue() const;
    std::optional<TimePoint> NextDue() const;
    void Fill(TimePoint now);
    TimePoint Free() const;
    bool IsCrowd() const;  // several have not answered yet
    std::vector<std::pair<GuidPrefix, Peer *>> ToBeAsked(TimePoint now);
    bool IsPartNext(TimePoint now) const;
    Outgoing TakeRequests(TimePoint now);
    Outgoing TakePart(TimePoint now);
    bool IsSummaryDue(TimePoint now) const;
    void SentSummary(TimePoint now);

    const Settings _settings;
    GuidPrefix _self{};
    CardSummary _own;
    std::vector<std::uint8_t> _packed;
    std::vector<OwnPart> _parts;
    BackoffTimer<TimePoint> _summary{{FirstSummary, LongestSummary, SummaryFactor, InitialSummaries}};
    BackoffTimer<TimePoint> _greeting{{FirstSummary, LongestSummary, SummaryFactor, GreetingSummaries}};
    std::optional<TimePoint> _nextPeriod;
    std::map<GuidPrefix, Peer> _peers;
    std::size_t _incomplete = 0;     // bytes of parts
    std::deque<TimePoint> _unknown;  // when participants that may have no card were asked first
    double _left = Burst;
    TimePoint _filledAt{};
};

}  // namespace Rabit::Rtps
