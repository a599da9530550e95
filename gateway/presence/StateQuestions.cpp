#include "presence/StateQuestions.h"

#include <rabit/base/Earliest.h>

#include "names/TakeTurns.h"

namespace Rabit
{
namespace
{

std::vector<std::uint8_t> BitsOf(const std::vector<bool> &states)
{
    std::vector<std::uint8_t> bits;
    for (std::size_t i = 0; i < states.size(); ++i)
    {
        if (states[i])
        {
            bits.resize(i / 8 + 1, 0);
            bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | 1U << i % 8);
        }
    }
    return bits;
}

}  // namespace

void StateQuestions::Set(const std::string &node, const std::vector<bool> &states, bool soon, Duration now)
{
    std::vector<std::uint8_t> bits = BitsOf(states);
    if (bits.empty())
    {
        _wanted.erase(node);
        return;
    }
    Entry &entry = _wanted[node];
    if (soon && !entry.DueSince)
    {
        entry.DueSince = now;
    }
    entry.States = std::move(bits);
}

std::optional<StateQuestions::Duration> StateQuestions::DueSince() const
{
    std::optional<Duration> since;
    for (const auto &[node, entry] : _wanted)
    {
        since = Earliest({since, entry.DueSince});
    }
    return since;
}

std::size_t StateQuestions::Longest() const
{
    std::size_t longest = 0;
    for (const auto &[node, entry] : _wanted)
    {
        longest = std::max(longest, entry.States.size());
    }
    return longest;
}

// Questions that are due come first.
std::vector<StateQuestions::Question> StateQuestions::Take(std::size_t most)
{
    std::vector<Question> questions;
    for (const bool onlyDue : {true, false})
    {
        std::vector<Question> more;
        TakeTurns(_wanted, _last, most - questions.size(),
                  [&](const std::string &node, Entry &entry)
                  {
                      const bool taken =
                          std::any_of(questions.begin(), questions.end(),
                                      [&node](const Question &question) { return question.Node == node; });
                      if (taken || (onlyDue && !entry.DueSince))
                      {
                          return false;
                      }
                      entry.DueSince.reset();
                      more.push_back({node, entry.States});
                      return true;
                  });
        questions.insert(questions.end(), more.begin(), more.end());
    }
    return questions;
}

}  // namespace Rabit
