#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Problems that other nodes' traffic shows, such as a gateway of another version. Each is reported for some
// seconds after its last sign. At most MostRemembered, however many names there are. Not thread-safe.
class RecentProblems
{
public:
    using Duration = std::chrono::nanoseconds;

    // How long a problem is reported after it was last noted, and how many of them are.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    // Replaces an earlier problem of the same node and subject. `now` is the monotonic clock.
    void Note(const Gateway::Problem &problem, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    struct Noted
    {
        Gateway::Problem What;
        Duration At{0};
    };
    std::map<std::pair<std::string, std::string>, Noted> _noted;  // by node and subject
};

}  // namespace Rabit
