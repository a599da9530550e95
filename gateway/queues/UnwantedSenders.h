#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Nodes that send to queues which accept nothing from them, so that people learn of it here. An honest node
// checks the announcement and refuses the call; so the sender's announcement is out of date, or its program
// does not check. Bounded. Not thread-safe.
class UnwantedSenders
{
public:
    using Duration = std::chrono::nanoseconds;

    // How long a sender is named after its last message, and how many are remembered.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    // A message of that node for that queue was refused. `now` is the monotonic clock.
    void Refused(std::string_view node, std::string_view queue, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    std::map<std::pair<std::string, std::string>, Duration> _last;  // by node and queue
};

}  // namespace Rabit
