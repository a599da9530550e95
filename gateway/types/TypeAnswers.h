#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace Rabit
{

// Which part of which type's text this node sends to whom next. Each answer goes to who asked alone, part by
// part, one answer after the other. Who asks again is answered more and more seldom.
//
// A pure state machine; `now` never goes back.
class TypeAnswers
{
public:
    using Duration = std::chrono::nanoseconds;
    // The text of a type; null: this node does not have it.
    using TextOf = std::function<const std::string *(std::uint64_t definition)>;

    // Between parts.
    static constexpr Duration PartGap = std::chrono::milliseconds(10);
    // From the end of an answer to the next one of the same text to the same node; the gap doubles.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // After so long without a question it is short again.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // Answers that wait, and that are remembered for their gaps; who asks beyond is not answered now.
    static constexpr std::size_t MostWaiting = 16;
    static constexpr std::size_t MostRemembered = 256;

    explicit TypeAnswers(TextOf textOf) : _textOf(std::move(textOf)) {}

    // The node lacks that text from that byte on.
    void Asked(const std::string &node, std::uint64_t definition, std::size_t from, Duration now);
    // When a part is to be sent; empty: none is.
    std::optional<Duration> Due() const;

    struct Part
    {
        std::string Node;
        std::uint64_t Definition = 0;
        std::size_t First = 0;
        const std::string *Text = nullptr;  // the whole

        std::size_t Left() const { return Text->size() - First; }
    };
    // What to send next, from its first byte on as much as fits; only if something is due.
    Part Next() const;
    // So many bytes of it were sent.
    void Sent(std::size_t bytes, Duration now);

    // Questions for texts that this node does not have, and those that were not answered because of too many.
    std::uint64_t Unknown() const { return _unknown; }
    std::uint64_t Dropped() const { return _dropped; }

private:
    using Key = std::pair<std::string, std::uint64_t>;  // node and definition
    struct Memory
    {
        Duration LastAsked{0};
        Duration NotBefore{0};
        Duration Gap = ShortestGap;
    };

    const TextOf _textOf;
    std::deque<Part> _waiting;
    std::map<Key, Memory> _memory;
    Duration _notBefore{0};
    std::uint64_t _unknown = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Rabit
