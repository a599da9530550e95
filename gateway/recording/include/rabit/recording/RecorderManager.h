#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>

#include <memory>
#include <string>

namespace Rabit
{
class RecordingDisk;

// Records what this process posts, receives, sends and is sent into MCAP files, as GatewayConfig::Record
// says: local messages whose types were made from IDL, those of other nodes among them; messages to and from
// queues of other nodes and what became of them; states of managers; how the clocks of the others stand;
// warnings and errors. gateway/recording/README.md has the topics. RunNode makes one if the configuration has
// a section `record`.
//
// A message is encoded on the thread that posts it, right after its other handlers, and put into bounded
// memory; nothing there waits for the disk. What could not be kept is counted, in the file and in
// Gateway/Fleet.
//
// The steps of managers that RecordSettings::Steps names are recorded if they start after this was made: what
// each read and did, encoded on its thread. They can be run again then (ManagerRerun.h).
//
// A message's name is looked for ten times a second: of one that is new, values that are posted before the
// first look are lost but for the last. So is what is posted while another thread posts the same name.
class RecorderManager final : public RabitManager
{
public:
    // Sets config.Tap, and so comes before the gateway. It must have config.Record (std::invalid_argument).
    // Without a disk the folder of the configuration is used; it is touched when there is something to write.
    explicit RecorderManager(GatewayConfig &config);
    RecorderManager(GatewayConfig &config, RabitWorkspace &workspace);
    RecorderManager(GatewayConfig &config, RabitWorkspace &workspace, std::unique_ptr<RecordingDisk> disk);
    // Ends the file; what other managers did at their end is in it.
    ~RecorderManager() override;

    // Has the black box written now, if there is one; `why` stands in the file. Any thread.
    void WriteBlackBox(const std::string &why);

    void Startup() final;
    void ExecuteUnitOfWork() final;
    void Shutdown() final;

private:
    class Parts;
    const std::unique_ptr<Parts> _parts;
};

}  // namespace Rabit
