#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>

#include <memory>

namespace Rabit
{
class RecorderManager;

// Requests posts that are missing in the recording of this node (RecordSettings::Backfill) from the
// recordings of other nodes. Answers such requests, and those for files (GatewayConfig::Fetch).
// gateway/backfill/README.md has the rules. RunNode makes one if IsUsed.
class BackfillManager final : public RabitManager
{
public:
    // True if this node has something to request or to answer.
    static bool IsUsed(const GatewayConfig &config);

    // Adds a queue and a tap to the configuration, so it must be made before the gateway, and after the
    // recorder, which must outlive it; without a recorder only files are sent. Throws ConfigError if `accept`
    // in the configuration has a queue `Backfill`.
    BackfillManager(GatewayConfig &config, RecorderManager *recorder);
    BackfillManager(GatewayConfig &config, RecorderManager *recorder, RabitWorkspace &workspace);
    ~BackfillManager() override;

    void Startup() final;
    void ExecuteUnitOfWork() final;

private:
    class Parts;
    const std::unique_ptr<Parts> _parts;
};

}  // namespace Rabit
