#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wire/PartsCollector.h"
#include "wire/TypeFrames.h"

namespace Rabit
{

// The texts of types that this node lacks: whom to ask when, and the parts that have come. Who does not
// answer is asked more and more seldom, until it is let go of.
//
// A pure state machine; `now` never goes back.
class TypeQuestions
{
public:
    using Duration = std::chrono::nanoseconds;

    // From one question to the next, at first; then twice as long each time.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(120);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    static constexpr std::size_t MostWanted = 32;

    struct Wanted
    {
        std::string Node;  // who is asked
        std::string Type;  // IDL name
        std::uint64_t Definition = 0;
    };
    // What is wanted already is asked of that node from now on. False: too many are.
    bool Want(const Wanted &wanted, Duration now);
    void LetGo(std::uint64_t definition) { _wanted.erase(definition); }
    bool IsEmpty() const { return _wanted.empty(); }

    struct Question
    {
        std::string Node;
        std::uint64_t Definition = 0;
        std::uint32_t From = 0;  // the first byte that is lacking
    };
    // When somebody is to be asked next.
    std::optional<Duration> NextDue() const;
    // How many there are to be asked now, no more than `most`; and those.
    std::size_t Due(Duration now, std::size_t most) const;
    std::vector<Question> Take(Duration now, std::size_t most);

    // A part that came of a node. Returns the text once it is whole and has the hash; it is lacking no more
    // then.
    std::optional<std::string> Add(const std::string &node, const TypeFrames::Part &part);
    // Texts that were whole and had another hash, and parts that nobody had asked that node for.
    std::uint64_t Wrong() const { return _wrong; }

private:
    struct Entry
    {
        std::string Node;
        std::string Type;
        Duration AskAt{0};
        Duration Gap = ShortestGap;
        PartsCollector Collected;
    };

    std::map<std::uint64_t, Entry> _wanted;
    std::uint64_t _lastAsked = 0;
    std::uint64_t _wrong = 0;
};

}  // namespace Rabit
