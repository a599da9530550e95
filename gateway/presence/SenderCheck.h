#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Compares who a sample of the gateways' own topics says it is from with the participant that wrote it, so
// that no node speaks or commands in the name of another one. The participant's name is what DDS discovery
// says of it: this keeps mistakes and foolish programs out; who means harm can take that name, too, and is a
// matter for DDS Security. Thread-safe, bounded.
class SenderCheck
{
public:
    using Duration = std::chrono::nanoseconds;

    // A problem is reported for so long after it was last seen; of so many pairs of names.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    // Whether a sample of that participant (SampleInfo::Node; empty: a program that is no node) may be from
    // the node that it names. If not, it is to be dropped, and is counted here. `now` is the monotonic clock.
    bool MaySpeakFor(std::string_view participant, std::string_view named, Duration now)
    {
        return (!participant.empty() && participant == named) || Refuse(participant, named, now);
    }

    // Samples that were to be dropped.
    std::uint64_t Refused() const;
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    using Claim = std::pair<std::string, std::string>;  // participant, and the node that it named

    // Returns false.
    bool Refuse(std::string_view participant, std::string_view named, Duration now);
    void Remember(std::string_view participant, std::string_view named, Duration now);

    mutable std::mutex _mutex;
    std::uint64_t _refused = 0;
    std::map<Claim, Duration> _claims;  // when each was seen last
};

}  // namespace Rabit
