#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

// The words of the QoS profiles in configurations, announcements and recordings, and on command lines. The
// index of a word is its profile.
inline const std::vector<std::string> QosProfileWords = {"state", "telemetry"};

// Returns the word of a profile. A number that is no QosProfile throws std::out_of_range.
inline const std::string &WordOf(QosProfile profile)
{
    return QosProfileWords.at(static_cast<std::size_t>(profile));
}

// Returns the profile of a word; empty for any other text.
inline std::optional<QosProfile> ProfileOf(const std::string &word)
{
    const auto found = std::find(QosProfileWords.begin(), QosProfileWords.end(), word);
    return found == QosProfileWords.end()
               ? std::nullopt
               : std::optional(static_cast<QosProfile>(found - QosProfileWords.begin()));
}

}  // namespace Rabit
