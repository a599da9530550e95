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

// The answers to commands that are still to be sent. The gateway does the rest of the way: an answer that it
// has accepted arrives. One that it refuses (because it has not yet heard of the other node, or too much
// waits for it already) is kept here and tried again, for half a minute. Not thread-safe.
class Answers
{
public:
    using Time = std::chrono::nanoseconds;  // of any clock that does not go back
    using Sender = std::function<bool(const std::string &to, const std::shared_ptr<Uav::CommandAck> &ack)>;

    static constexpr std::chrono::milliseconds RetryPeriod{200};
    static constexpr std::chrono::seconds Keep{30};
    static constexpr std::size_t MaxKept = 1000;

    // An empty address is that of nobody, and the answer is dropped.
    void Add(const std::string &to, const Uav::CommandAck &ack, Time now);
    // Tries all, in their order.
    void Send(Time now, const Sender &sender);
    bool AnyWait() const { return !_waiting.empty(); }
    // How many wait and were given up; empty if none.
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
