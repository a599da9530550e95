#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/transport/Transport.h>

#include <rabit/RabitWorkspace.h>
#include <functional>
#include <vector>
#include <string>
#include <memory>

namespace Rabit
{
class Exploration;
class FleetExplorer;

// Name of the local message in which a gateway reports the fleet, unless the configuration names the gateway.
// Its type is Rabit::Gateway::Fleet (rabit/gateway/Fleet.h).
inline constexpr const char *FleetMessageName = "Gateway/Fleet";
// The same with the name that the configuration gives.
inline std::string FleetMessageNameOf(const GatewayConfig &config)
{
    return config.Name + "/Fleet";
}

// Makes the transport of each path of the configuration, in their order: GatewayManager(config,
// TransportsOf(config, MakeTransport)). A gateway without `paths` has one.
std::vector<std::shared_ptr<Transport>> TransportsOf(
    const GatewayConfig &config,
    const std::function<std::shared_ptr<Transport>(const std::string &name)> &make);

// Joins this process to the other nodes of its domain.
//
// - Every `publish` message posted locally is written to the DDS topic of its name.
// - Every `subscribe` message of another node is posted locally as `<node>/<message>`, stamped with the time
//   of its post by the wall clock of its origin. Its age counts from that post, whatever the clocks show.
//   Nothing of a node is posted before a beat of that node has come, so an old value never looks new.
// - AddMessageToQueue("<node>/<queue>", message) sends a message to a queue of another node,
//   "*/<queue>" to that queue of every live node that accepts it. False means refused; Gateway/Fleet counts
//   why. Every accepted message comes to exactly one outcome; give AddMessageToQueue a RabitQueueReceipt to
//   learn which. When the gateway ends, waiting messages are Expired, and messages that were sent and not
//   acknowledged are InDoubt.
// - `accept` queues receive messages of other nodes in order; a full queue holds the sender back, without
//   loss.
// - Gateway/Fleet shows the other nodes, counters, and by name why expected data does not come. A problem
//   that lasts two seconds is logged once (RabitLog, as a warning), and once more when it is gone.
//
// Threads: Startup, ExecuteUnitOfWork and Shutdown run as for every manager. Mirrored messages are posted on
// the transport's thread. Handlers registered on them run on a thread of the gateway's that does nothing else
// (RabitHandlerThread); RabitQuickHandlers run on the transport's thread, and so do all under a stepped
// transport.
//
// Several gateways may serve one workspace, for instance one on a radio and one on a LAN. Each must have a
// name of its own (GatewayConfig::Name): a second gateway of one name throws ConfigError. A queue message
// goes through the gateway that knows the node, "*/<queue>" to the nodes of all gateways. A node that two
// gateways know is a problem by name; its queue messages go through the gateway that was there first.
//
// Errors: the constructor throws ConfigError for a configuration that cannot be used, such as `subscribe`
// twice for one message, an unknown type or a name taken. It also throws ConfigError for a TransportError of
// the backend. Then nothing has been started. RunNode makes it one line and exit code 2; a program that makes
// the gateway by hand catches it (RunProgram does that for any main()), or the exception ends the process.
// Afterwards nothing from the network throws or ends the process.
class GatewayManager : public RabitManager
{
public:
    // Opens the transport at once. The transport is kept until the gateway is gone; null is a programming
    // error (std::invalid_argument). The workspace must outlive the gateway; without one it is the default
    // workspace. Time comes from the workspace's clock and chance from `random`: under a stepped reactor and
    // a simulated transport nothing else decides what happens.
    GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport);
    GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport,
                   RabitWorkspace &workspace, RandomSource random = SystemRandom);
    // Takes one transport for each of GatewayConfig::Paths, in their order; the former constructors use one
    // for all. Throws std::invalid_argument if there are not as many transports as paths.
    GatewayManager(const GatewayConfig &config, std::vector<std::shared_ptr<Transport>> transports,
                   RabitWorkspace &workspace = *RabitWorkspace::GetWorkspace(),
                   RandomSource random = SystemRandom);
    ~GatewayManager() override;

    // Returns the view of the fleet that tools use: announcements, types, subscriptions at run time. Valid as
    // long as the manager lives; any thread.
    FleetExplorer &Explorer();

    // A gateway that ran before joins again, in a new incarnation.
    void Startup() final;
    void ExecuteUnitOfWork() final;
    // Says goodbye to the other nodes and leaves the network.
    void Shutdown() final;

private:
    class Parts;

    const GatewayConfig _config;
    const std::vector<std::shared_ptr<Transport>> _transports;  // of each path
    const RandomSource _random;
    std::unique_ptr<Exploration> _exploration;
    std::unique_ptr<Parts> _parts;  // null if joining again failed
};

}  // namespace Rabit
