#pragma once

#include "uav.idl.h"

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

namespace Swarm
{

// Answers to commands that are not sent yet. An answer that the gateway accepts arrives. The gateway may
// refuse it, because it does not know the other node yet, or too much waits already. It is then kept here and
// retried for half a minute. Not thread-safe.
class Answers
{
public:
    using Time = std::chrono::nanoseconds;  // of any clock that does not go back
    using Sender = std::function<bool(const std::string &to, const std::shared_ptr<Uav::CommandAck> &ack)>;

    static constexpr std::chrono::seconds Keep{30};
    static constexpr std::size_t MaxKept = 1000;

    // An answer to an empty address is dropped.
    void Add(const std::string &to, const Uav::CommandAck &ack, Time now);
    // Tries to send all answers, in order.
    void Send(Time now, const Sender &sender);
    // The numbers of waiting and abandoned answers, as text; empty if there are none.
    std::string Text() const;

private:
    struct Answer
    {
        std::string To;
        std::shared_ptr<Uav::CommandAck> Ack;
        Time Since;
    };

    std::deque<Answer> _waiting;
    std::size_t _givenUp = 0;
};

}  // namespace Swarm
