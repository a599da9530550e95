#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

// The States that this node requests from others, in each of its beats until Set or Forget ends that. Not
// thread-safe.
class StateQuestions
{
public:
    using Duration = std::chrono::nanoseconds;

    // Sets the requested States, by index; none: no request. `soon`: the request does not wait for the next
    // period.
    void Set(const std::string &node, const std::vector<bool> &states, bool soon, Duration now);
    void Forget(const std::string &node) { _wanted.erase(node); }

    struct Question
    {
        std::string Node;
        std::vector<std::uint8_t> States;  // as in a beat
    };
    // Since when the oldest request marked `soon` waits; empty: none waits.
    std::optional<Duration> DueSince() const;
    bool IsEmpty() const { return _wanted.empty(); }
    // The questions of the next beat; the nodes take turns.
    std::vector<Question> Take(std::size_t most);
    // Number of nodes with a request, at most `most`; and the bytes of the longest question.
    std::size_t Count(std::size_t most) const { return std::min(most, _wanted.size()); }
    std::size_t Longest() const;

private:
    struct Entry
    {
        std::vector<std::uint8_t> States;
        std::optional<Duration> DueSince;
    };

    std::map<std::string, Entry> _wanted;
    std::string _last;
};

}  // namespace Rabit
