#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wire/PartsCollector.h"
#include "wire/TypeFrames.h"

namespace Rabit
{

// The texts of types and the reports of nodes (wire/NodeReports.h) that this node lacks: which node to ask
// and when, and the parts that have come. The interval between questions for a text doubles, until the text
// has come, or LetGo or Forget is called.
//
// A pure state machine; `now` never goes back.
class TypeQuestions
{
public:
    using Duration = std::chrono::nanoseconds;

    // From one question to the next, at first; doubles with each question.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(120);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    static constexpr std::size_t MostWanted = 32;

    struct Wanted
    {
        std::string Node;  // the node to ask
        std::string Type;  // IDL name; empty: a report of that node
        std::uint64_t Definition = 0;
    };
    // Starts to ask that node. If another node was asked for the text of a type, its parts are dropped. A
    // report replaces one of that kind and node; an echo is asked for once. False: too many texts are wanted.
    bool Want(const Wanted &wanted, Duration now);
    // That text is no longer wanted.
    void LetGo(const Wanted &wanted) { _wanted.erase(KeyOf(wanted)); }
    // Nothing is wanted from that node any more. For a node that does not hear questions: each due question
    // brings a beat forward.
    void Forget(const std::string &node)
    {
        std::erase_if(_wanted, [&node](const auto &entry) { return entry.second.Node == node; });
    }
    bool IsEmpty() const { return _wanted.empty(); }

    struct Question
    {
        std::string Node;
        std::uint64_t Definition = 0;
        std::uint32_t From = 0;  // the first missing byte
    };
    // When the next question is due; empty if no text is wanted.
    std::optional<Duration> NextDue() const;
    // The number of questions that are due, at most `most`; and those questions.
    std::size_t Due(Duration now, std::size_t most) const;
    std::vector<Question> Take(Duration now, std::size_t most);

    struct Answer
    {
        std::string Text;
        Duration AskedAt{0};  // the last time
    };
    // Adds a part that came from a node. Returns the text once it is whole and has the hash; the text is then
    // no longer wanted.
    std::optional<Answer> Add(const std::string &node, const TypeFrames::Part &part);
    // Whole texts with another hash, and parts of texts that this node did not request from their sender.
    std::uint64_t Wrong() const { return _wrong; }

private:
    struct Entry
    {
        std::string Node;
        std::string Type;
        BackoffTimer<Duration> Ask{{ShortestGap, LongestGap}};
        Duration AskedAt{0};
        PartsCollector Collected;
    };

    using Key = std::pair<std::uint64_t, std::string>;  // definition; the node if it is a report
    static Key KeyOf(const Wanted &wanted);

    std::map<Key, Entry> _wanted;
    Key _lastAsked;
    std::uint64_t _wrong = 0;
};

}  // namespace Rabit
