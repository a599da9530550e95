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

inline const std::string &WordOf(QosProfile profile)
{
    return QosProfileWords.at(static_cast<std::size_t>(profile));
}

// Empty for another word.
inline std::optional<QosProfile> ProfileOf(const std::string &word)
{
    const auto found = std::find(QosProfileWords.begin(), QosProfileWords.end(), word);
    return found == QosProfileWords.end()
               ? std::nullopt
               : std::optional(static_cast<QosProfile>(found - QosProfileWords.begin()));
}

}  // namespace Rabit
