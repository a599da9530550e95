#include "Answers.h"

#include <utility>

namespace Swarm
{

void Answers::Add(const std::string &to, const Uav::CommandAck &ack, Time now)
{
    if (to.empty())
        return;
    if (_waiting.size() == MaxKept)
    {
        _waiting.pop_front();
        ++_givenUp;
    }
    _waiting.push_back({to, std::make_shared<Uav::CommandAck>(ack), now});
}

void Answers::Send(Time now, const Sender &sender)
{
    std::deque<Answer> kept;
    for (Answer &answer : _waiting)
    {
        if (sender(answer.To, answer.Ack))
            continue;
        if (now - answer.Since < Keep)
            kept.push_back(std::move(answer));
        else
            ++_givenUp;
    }
    _waiting = std::move(kept);
}

std::string Answers::Text() const
{
    std::string text;
    if (!_waiting.empty())
        text = std::to_string(_waiting.size()) + " answers wait";
    if (_givenUp > 0)
        text += (text.empty() ? "" : ", ") + std::to_string(_givenUp) + " answers given up";
    return text;
}

}  // namespace Swarm
