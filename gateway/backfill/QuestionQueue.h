#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "backfill.idl.h"

namespace Rabit::Backfill
{

// Questions of other nodes that wait for their answers. A pure state machine; `now` never goes back. Not
// thread-safe.
class QuestionQueue
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr std::size_t Most = 256;
    // Most questions of one node: one for each message, and the parts of files that it requests ahead.
    static constexpr std::size_t MostOfANode = 32;
    // Time in which a question is answered again if its answer was refused, and the pause before each try.
    static constexpr Duration Patience = std::chrono::seconds(30);
    static constexpr Duration Pause = std::chrono::milliseconds(500);

    enum class Outcome
    {
        Answered,
        Later,    // the node has enough answers under way, or the answer takes longer
        Refused,  // the answer could not be sent
    };

    // Returns false, and drops the question, if too many wait.
    bool Add(std::string node, Question question)
    {
        const auto ofNode = std::count_if(_waiting.begin(), _waiting.end(),
                                          [&node](const Waiting &one) { return one.Node == node; });
        if (_waiting.size() >= Most || static_cast<std::size_t>(ofNode) >= MostOfANode)
        {
            return false;
        }
        _waiting.push_back({std::move(node), std::move(question)});
        return true;
    }

    // Calls `answer` with each question that is due, the oldest first.
    void Answer(Duration now, const std::function<Outcome(const std::string &, const Question &)> &answer)
    {
        for (auto one = _waiting.begin(); one != _waiting.end();)
        {
            Outcome outcome = Outcome::Later;
            if (one->Tries == 0 || now >= one->NotBefore)
            {
                outcome = answer(one->Node, one->Asked);
            }
            if (outcome == Outcome::Refused)
            {
                ++one->Tries;
                one->NotBefore = now + Pause;
            }
            const bool isOver = outcome == Outcome::Answered || one->Tries > Patience / Pause;
            one = isOver ? _waiting.erase(one) : std::next(one);
        }
    }
    std::size_t Size() const { return _waiting.size(); }

private:
    struct Waiting
    {
        std::string Node;
        Question Asked;
        int Tries = 0;  // whose answers were refused
        Duration NotBefore{0};
    };

    std::deque<Waiting> _waiting;
};

}  // namespace Rabit::Backfill
