#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "presence/OffersCollector.h"

namespace Rabit
{

// The announcements that this node lacks: when to ask for which, and the parts that have come. A node that
// does not answer is asked more and more seldom.
//
// A pure state machine; `now` never goes back. It holds one announcement for each node that Lacks named and
// LetGo did not.
class MissingOffers
{
public:
    using Duration = std::chrono::nanoseconds;

    // Time before the first question: the announcement may be on its way.
    static constexpr Duration AskAfter = std::chrono::milliseconds(60);
    // Longest time from one question to the next. It begins at twice AskAfter and grows by half each time.
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // The first questions follow each other more quickly: a question or its answer may be lost, and a radio
    // that loses datagrams is not full.
    static constexpr Duration QuickGap = std::chrono::milliseconds(150);
    static constexpr int QuickQuestions = 20;

    // Limits the gap to `gap` for the first `questions` questions, in place of the two above: for a tool,
    // which looks and goes.
    void BeQuick(Duration gap, int questions)
    {
        _gaps.Quick = gap;
        _gaps.QuickSteps = questions;
    }

    // The node's beats name an announcement with that digest, which this node lacks.
    void Lacks(const std::string &node, std::uint32_t digest, Duration now);
    // No announcement of the node is lacking, or the node is away and cannot be asked.
    void LetGo(const std::string &node) { _lacking.erase(node); }
    // Adds a part of a lacking announcement. Returns the encoded announcement once it is complete.
    std::optional<std::vector<std::uint8_t>> Add(const std::string &node,
                                                 const Gateway::AnnouncementPart &part);

    struct Question
    {
        std::string Node;
        std::uint16_t From = 0;  // the first byte that is lacking
    };
    // When the next question is due.
    std::optional<Duration> NextDue() const;
    bool IsEmpty() const { return _lacking.empty(); }
    // Number of nodes to ask now, at most `most`.
    std::size_t Due(Duration now, std::size_t most) const;
    // The nodes to ask now, in turns. `delay` is the queueing delay of datagrams now: no node is asked again
    // before its answer can have come.
    std::vector<Question> Take(Duration now, std::size_t most, Duration delay = Duration(0));
    // Number of announcements that did not match their digest.
    std::uint64_t Wrong() const { return _wrong; }

private:
    struct Entry
    {
        explicit Entry(const Backoff::Settings &gaps) : Ask(gaps) {}

        std::uint32_t Digest = 0;
        BackoffTimer<Duration> Ask;
        OffersCollector Collected;
    };

    std::map<std::string, Entry> _lacking;
    std::string _lastAsked;
    Backoff::Settings _gaps{2 * AskAfter, LongestGap, 1.5, 0, QuickQuestions, QuickGap};
    std::uint64_t _wrong = 0;
};

}  // namespace Rabit
