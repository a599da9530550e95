#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "backfill.idl.h"
#include "backfill/Ledger.h"
#include "backfill/PostAnswers.h"

namespace Rabit::Backfill
{

// Decides which posts to request from which node, and takes in the answers. MostAsked questions are open at
// once: so the nodes of a fleet do not fill one channel together, and a cut or a restart costs little.
//
// Questions and answers travel as queue messages: while both ends live none is lost. A question is asked
// again if it failed, if the node or this one restarted, and, to be safe, after Patience.
//
// A pure state machine; `now` never goes back. Not thread-safe.
class Requester
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr std::size_t MostAsked = 1;
    // A question that is open for longer holds up no other node.
    static constexpr Duration Slow = std::chrono::seconds(10);
    // After a full answer, nothing is asked for this many times as long as the answer took; after a smaller
    // one for less. So the channel is free for live values and commands most of the time, whatever its
    // capacity.
    static constexpr int Rest = 4;
    // Bytes of a post in its answer: of the largest sample that a node can post, and some more.
    static constexpr std::uint64_t LargestPost = (std::uint64_t{64} << 20) + PostStore::PostOverhead;
    // From one look at the newest posts to the next: doubles up to the longest while nothing is missing.
    static constexpr Duration ShortestLook = std::chrono::seconds(10);
    static constexpr Duration LongestLook = std::chrono::seconds(60);
    // Until a node that refused a question, or did not answer it, is asked again.
    static constexpr Duration Pause = std::chrono::seconds(30);
    // A part that can never be read is told for this long at least, and as long as it could be requested.
    static constexpr Duration LossTold = LongestLook;
    // Time in which a node is UP until an answer is taken for lost. The next one is asked to be half as
    // large, since the channel may be too slow. After an answer that came in a quarter of this, the next one
    // is asked to be twice as large.
    static constexpr Duration Patience = std::chrono::seconds(120);

    // The ledger must outlive the object. Posts older than `last` are not requested. Questions are numbered
    // from `firstNumber` on, which is to be random: an answer to a question of an earlier incarnation of this
    // node leaves out posts that were lost with it.
    Requester(Ledger &ledger, std::chrono::seconds last, std::uint64_t firstNumber)
        : _ledger(ledger), _last(last), _nextNumber(firstNumber)
    {
    }

    // The state of a node, whenever it may have changed. `messages` are those to be requested from it.
    void SetNode(const std::string &node, std::uint64_t incarnation, bool isUp,
                 const std::vector<std::string> &messages, Duration now);

    // The ledger was cleared: the nodes are asked anew what they have, and answers under way are dropped.
    void StartOver(Duration now);

    struct Asking
    {
        std::string Node;
        Question What;
    };
    // The questions to send now. Failed must be called of each that cannot be delivered.
    std::vector<Asking> Due(Duration now);
    void Failed(const std::string &node, const Question &question, Duration now);

    enum class Taken
    {
        Recorded,
        Refused,  // it is not to be recorded
        NotNow
    };
    // Records a post.
    using Record = std::function<Taken(const Series &series, const Post &post)>;
    // Takes in an answer of that node. Returns the range that is whole in the recording now; empty: none is.
    std::optional<std::pair<Series, Range>> Answered(const std::string &node, Answer answer,
                                                     const Record &record, Duration now);

    // Posts that were recorded; that came and were there already; answers that nobody asked for, or that do
    // not decode.
    std::uint64_t Recorded() const { return _recorded; }
    std::uint64_t Repeated() const { return _repeated; }
    std::uint64_t Malformed() const { return _malformed; }
    // Nodes that do not answer for that message, and why, by node and message.
    std::map<std::pair<std::string, std::string>, std::string> Refusals() const;
    // Node and message of posts that come live or never, since the node does not record them.
    std::set<std::pair<std::string, std::string>> LiveOnly() const;

private:
    struct Asked
    {
        Question What;
        bool LooksAtNewest = false;
        Duration At{0};
    };
    // A post that is larger than an answer, as far as it has come.
    struct LargePost
    {
        std::uint64_t Incarnation = 0;
        Range Covered;  // whole once it is here: it is the first post, and the only one that was lacking
        std::uint64_t Size = 0;
        std::vector<std::uint8_t> Bytes;
    };
    struct Wanted
    {
        std::optional<Asked> Open;
        Duration NextSpans{0};
        Duration NextLook{0};
        Backoff Look{{ShortestLook, LongestLook}};
        Duration NotBefore{0};
        std::size_t Most = PostAnswers::LargestAnswer;  // bytes of an answer
        std::optional<LargePost> Large;                 // that comes in parts
        std::string Refusal;
        std::optional<Series> Damaged;  // a part of its posts can never be read
        Stamp DamagedUntil = 0;
        Duration DamagedAt{0};  // when the node told
        bool IsLiveOnly = false;
    };
    struct Node
    {
        std::uint64_t Incarnation = 0;
        bool IsUp = false;
        std::map<std::string, Wanted> Messages;
        std::string LastAsked;
    };

    static const Asked *OpenQuestion(const Node &node);
    std::optional<Asking> NextOf(const std::string &name, Node &node, Duration now);
    std::optional<Asked> Next(const std::string &node, std::uint64_t present, const std::string &message,
                              const Wanted &wanted, Duration now) const;
    void TakeSpans(const std::string &node, const Answer &answer, Wanted &wanted, Duration now);
    enum class Part
    {
        None,  // the answer is whole
        One,   // more is to come
        Last,  // with it the answer is that of the whole post
        Malformed
    };
    static Part TakePart(const Asked &asked, Answer &answer, Wanted &wanted);
    void RestAfter(std::size_t bytes, const Asked &asked, Duration now);
    std::optional<std::pair<Series, Range>> TakePosts(const std::string &node, const Asked &asked,
                                                      Answer &answer, const Record &record, Wanted &wanted,
                                                      Duration now);

    Ledger &_ledger;
    const std::chrono::seconds _last;
    std::uint64_t _nextNumber;
    std::map<std::string, Node> _nodes;
    std::string _lastAsked;  // of the nodes
    Duration _restUntil{0};
    std::uint64_t _recorded = 0;
    std::uint64_t _repeated = 0;
    std::uint64_t _malformed = 0;
};

}  // namespace Rabit::Backfill
