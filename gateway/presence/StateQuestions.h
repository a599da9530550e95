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

// Which States this node asks others for, in each of its beats until it is told otherwise. Not thread-safe.
class StateQuestions
{
public:
    using Duration = std::chrono::nanoseconds;

    // The States, by place; none: nothing is asked of the node. `soon`: they do not wait for the next period.
    void Set(const std::string &node, const std::vector<bool> &states, bool soon, Duration now);
    void Forget(const std::string &node) { _wanted.erase(node); }

    struct Question
    {
        std::string Node;
        std::vector<std::uint8_t> States;  // as in a beat
    };
    // Since when something is to be asked for soon that was not yet.
    std::optional<Duration> DueSince() const;
    bool IsEmpty() const { return _wanted.empty(); }
    // What is to be asked in the next beat, in turns.
    std::vector<Question> Take(std::size_t most);
    // Of how many nodes something is asked, no more than `most`; and the bytes of the longest question.
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
