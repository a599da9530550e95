#pragma once

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

// The announcements that this node lacks: when to ask for which, and the parts that have come. Who does not
// answer is asked more and more seldom.
//
// A pure state machine; `now` never goes back. It holds one announcement for each node that was named and not
// let go of.
class MissingOffers
{
public:
    using Duration = std::chrono::nanoseconds;

    // It may be on its way.
    static constexpr Duration AskAfter = std::chrono::milliseconds(60);
    // From one question to the next at most; at first twice AskAfter, then half as long again each time.
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // The first questions follow each other more quickly: a question or its answer may be lost, and a radio
    // that loses datagrams is not full.
    static constexpr Duration QuickGap = std::chrono::milliseconds(300);
    static constexpr int QuickQuestions = 12;

    // Limits the gap to `gap` for the first `questions` questions, in place of the two above: for a tool,
    // which looks and goes.
    void BeQuick(Duration gap, int questions)
    {
        _quickGap = gap;
        _quickQuestions = questions;
    }

    // The node's beats mean an announcement with that digest, which this node has not.
    void Lacks(const std::string &node, std::uint32_t digest, Duration now);
    // Nothing is lacking of the node, or it is not there to be asked.
    void LetGo(const std::string &node) { _lacking.erase(node); }
    // A part of what is lacking. Returns the encoded announcement once it is complete.
    std::optional<std::vector<std::uint8_t>> Add(const std::string &node,
                                                 const Gateway::AnnouncementPart &part);

    struct Question
    {
        std::string Node;
        std::uint16_t From = 0;  // the first byte that is lacking
    };
    // When somebody is to be asked next.
    std::optional<Duration> NextDue() const;
    bool IsEmpty() const { return _lacking.empty(); }
    // How many there are to be asked now, no more than `most`.
    std::size_t Due(Duration now, std::size_t most) const;
    // The nodes to ask now, in turns. `delay` is how long datagrams wait in queues now: nobody is asked again
    // before the answer can have come.
    std::vector<Question> Take(Duration now, std::size_t most, Duration delay = Duration(0));
    // Announcements that were not what their digest says.
    std::uint64_t Wrong() const { return _wrong; }

private:
    struct Entry
    {
        std::uint32_t Digest = 0;
        Duration AskAt{0};
        Duration Gap = 2 * AskAfter;
        int Asked = 0;
        OffersCollector Collected;
    };

    std::map<std::string, Entry> _lacking;
    std::string _lastAsked;
    Duration _quickGap = QuickGap;
    int _quickQuestions = QuickQuestions;
    std::uint64_t _wrong = 0;
};

}  // namespace Rabit
