#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/NamePattern.h>

#include <string>

namespace Rabit::Backfill
{

// True if that node may request posts from the recording of this one. The configuration must say what to
// record. Without `backfill_to`, nobody may if some path has keys.
inline bool MayRequestPosts(const GatewayConfig &config, const std::string &node)
{
    if (config.Record->BackfillTo)
    {
        return MatchesAny(*config.Record->BackfillTo, node);
    }
    return !SomePathHasKeys(config);
}

}  // namespace Rabit::Backfill
