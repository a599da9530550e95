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

// Nodes that send to queues which accept nothing of them, so that people learn of it here. An honest node
// asks itself before, and is refused at the call; so it is one that knew better a moment ago, or whose
// program does not ask. Bounded. Not thread-safe.
class UnwantedSenders
{
public:
    using Duration = std::chrono::nanoseconds;

    // One is named for so long after its last message; so many are.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    // A message of that node for that queue was refused. `now` is the monotonic clock.
    void Refused(std::string_view node, std::string_view queue, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    std::map<std::pair<std::string, std::string>, Duration> _last;  // by node and queue
};

}  // namespace Rabit
