#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>

#include <memory>
#include <string>

namespace Rabit
{
class RecordingDisk;
class RecordingTarget;

// Records this process into MCAP files, as GatewayConfig::Record says: local messages whose types were made
// from IDL, mirrored ones included; messages to and from queues of other nodes, and their outcomes; states
// of managers; offsets of the clocks of other nodes; warnings and errors. gateway/recording/README.md has
// the topics. RunNode makes one if the configuration has a section `record`.
//
// A message is encoded on the thread that posts it, right after its other handlers, and put into bounded
// memory: that thread never waits for the disk. Lost messages are counted, in the file and in
// Gateway/Fleet.
//
// The steps of a manager that RecordSettings::Steps names are recorded if it starts after this object was
// made. They hold what the manager read and did, encoded on its thread, and can be run again
// (ManagerRerun.h).
//
// New message names are looked for ten times a second. Of the values posted before that, only the last is
// recorded. A post is also lost if another thread posts the same name at the same time.
class RecorderManager final : public RabitManager
{
public:
    // Sets config.Tap, so it must be made before the gateway. Throws std::invalid_argument if config.Record
    // is not set. Without a disk it uses the folder of the configuration, from the first write on.
    explicit RecorderManager(GatewayConfig &config);
    RecorderManager(GatewayConfig &config, RabitWorkspace &workspace);
    RecorderManager(GatewayConfig &config, RabitWorkspace &workspace, std::unique_ptr<RecordingDisk> disk);
    // Ends the file, which also holds what other managers did at their end.
    ~RecorderManager() override;

    // For a program that subscribes while it runs (FleetExplorer::Subscribe), before it does: messages that fit
    // the rule are recorded as those of other nodes. Any thread.
    void AddSubscription(const SubscribeRule &rule);
    // Has the black box written now, if there is one; `why` stands in the file. Any thread.
    void WriteBlackBox(const std::string &why);

    // The recording itself, for other parts of the gateway that record.
    const std::shared_ptr<RecordingTarget> &Target() const;

    void Startup() final;
    void ExecuteUnitOfWork() final;
    void Shutdown() final;

private:
    class Parts;
    const std::unique_ptr<Parts> _parts;
};

}  // namespace Rabit
