#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace Rabit
{

// Decides which part of which text this node sends next, and to which node: texts of types, and reports of
// this node (wire/NodeReports.h). Each answer goes to the asking node alone, part by part, one answer after
// the other. The interval between repeated answers grows; all reports of one kind count as one text.
//
// A pure state machine; `now` never goes back.
class TypeAnswers
{
public:
    using Duration = std::chrono::nanoseconds;
    // Returns the text of a type, or a report as it is now; null if this node does not have it.
    using TextOf = std::function<std::shared_ptr<const std::string>(std::uint64_t definition)>;

    // Time between two parts.
    static constexpr Duration PartGap = std::chrono::milliseconds(10);
    // From the end of an answer to the next one of the same text to the same node; the interval doubles.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // After this time without a question, the interval is ShortestGap again.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // Limits of waiting answers and of remembered intervals; a question beyond them is dropped.
    static constexpr std::size_t MostWaiting = 16;
    static constexpr std::size_t MostRemembered = 256;

    explicit TypeAnswers(TextOf textOf) : _textOf(std::move(textOf)) {}

    // The node lacks that text from byte `from` on.
    void Asked(const std::string &node, std::uint64_t definition, std::size_t from, Duration now);
    // When to send the next part; empty if no answer waits.
    std::optional<Duration> Due() const;

    struct Part
    {
        std::string Node;
        std::uint64_t Definition = 0;
        std::size_t First = 0;
        std::shared_ptr<const std::string> Text{};  // the whole

        std::size_t Left() const { return Text->size() - First; }
    };
    // The part to send next, from its first byte on as much as fits. Only if Due() is not empty.
    Part Next() const;
    // `bytes` bytes of that part were sent.
    void Sent(std::size_t bytes, Duration now);

    // Unknown: questions for a text that this node lacks or that is too large to send, or from beyond its
    // end. Dropped: questions beyond MostWaiting or MostRemembered.
    std::uint64_t Unknown() const { return _unknown; }
    std::uint64_t Dropped() const { return _dropped; }

private:
    using Key = std::pair<std::string, std::uint64_t>;  // node; definition, of a report without its argument
    static Key KeyOf(const std::string &node, std::uint64_t definition);
    // Returns the whole text; null, and counted, if it cannot be sent from that byte on.
    std::shared_ptr<const std::string> TextFrom(std::uint64_t definition, std::size_t from);
    struct Memory
    {
        Duration LastAsked{0};
        Duration NotBefore{0};
        Backoff Gap{{ShortestGap, LongestGap}};
    };

    const TextOf _textOf;
    std::deque<Part> _waiting;
    std::map<Key, Memory> _memory;
    Duration _notBefore{0};
    std::uint64_t _unknown = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Rabit
