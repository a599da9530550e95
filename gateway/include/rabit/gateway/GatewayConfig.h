#pragma once

#include <rabit/gateway/ForeignRule.h>
#include <rabit/gateway/NodeParameters.h>
#include <rabit/gateway/PanelRule.h>
#include <rabit/gateway/TrafficClass.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{
class AgreementHub;
class FleetMember;
class GatewayTap;

// How a mirrored message travels. Both ends of a message must agree; a subscription takes over what the
// publisher announces unless it names one itself.
enum class QosProfile
{
    // The last value reaches every subscriber, late joiners too; a node that lacks it requests it. For values
    // that must be known.
    State,
    // Nothing is retransmitted. For values that are soon replaced by newer ones.
    Telemetry
};

// A local message that other nodes may see.
struct PublishRule
{
    std::string Message;                 // local message name = topic name
    std::string Type;                    // IDL name
    QosProfile Qos = QosProfile::State;  //
    double MaxRate = 0.0;                // samples a second at most, up to 1e6; 0: no limit
    // Its priority where capacity is short, any but Presence; unset: State or Telemetry, as the QoS.
    std::optional<TrafficClass> Class{};
    double Weight = 1.0;  // among those of its class, 0.01 to 100
    int Line = 0;         // where it stands in the file, for error messages; 0: made in code
};

// A message of other nodes that appears here as `<node>/<message>`.
struct SubscribeRule
{
    std::string Message;
    std::string Type;
    std::vector<std::string> From = {"*"};  // node names; `*` and `?` are wildcards
    std::optional<QosProfile> Qos{};        // unset: as the publisher announces
    int Line = 0;
};

// A local queue into which other nodes may put messages.
struct AcceptRule
{
    std::string Queue;               // name of a local RabitMessageQueue<std::shared_ptr<RabitMessage>>
    std::vector<std::string> Types;  // IDL names, at least one
    std::vector<std::string> From = {"*"};  // nodes that may send; `*` and `?` are wildcards
    int Line = 0;
};

// How messages to queues of other nodes are kept. Needed only to change the defaults. The first rule that
// fits a link holds.
struct SendRule
{
    std::string To = "*";                   // node name; `*` and `?` are wildcards
    std::string Queue = "*";                // queue name, likewise
    std::size_t Capacity = 1000;            // messages that may wait, 1 to 1,000,000
    std::size_t CapacityBytes = 16u << 20;  // bytes that may wait, 1 to 2^40
    std::chrono::milliseconds Expire{0};    // a message older than this is never delivered; 0: never too old
    std::size_t Window = 256;               // messages under way at once, 1 to 256
    bool RedeliverInDoubt = false;          // send again, flagged, messages that a restart left in doubt
    // Priority of the messages where capacity is short, any but Presence.
    TrafficClass Class = TrafficClass::Command;
    double Weight = 1.0;  // among those of its class, 0.01 to 100
    int Line = 0;
};

// Limits on the bytes that this node puts on the air.
struct RadioSettings
{
    // Bytes in any one second, IP headers and all above included; from SmallestBudget to 1e9. Unset (`auto`):
    // the rate follows the capacity of the channel, and is unlimited where the channel does not limit it.
    std::optional<double> Budget{};
    // Longest time between beats with a budget, 500 ms to 60 s. Beats take a twentieth of the budget, but
    // come no more often than every 500 ms. The node is STALE after three times the time between its beats,
    // LOST after seven times, unless the other node has a LostAfter. Without a budget a beat is sent every
    // 500 ms.
    std::chrono::milliseconds SlowestBeat{2000};
};

// The smallest budget, in bytes a second, with which a node can send its beats in time and anything else.
double SmallestBudget(std::chrono::milliseconds slowestBeat);

// Keys of a fleet: each datagram is encrypted and signed, and nodes without keys of this fleet are neither
// heard nor answered (keys/README.md).
struct SecuritySettings
{
    std::string Keys;  // the node's folder, which `rabit keys add` made
    // Set: in place of Keys, a membership that the program made (rabit/transport/FleetMember.h). Only in
    // code. Its name and permissions are not compared with the configuration at the start.
    std::shared_ptr<FleetMember> Member{};
};

// One of several networks by which a node reaches the others, for instance a mesh radio and a modem. Paths
// are listed from the best to the worst: a node is reached by the first one that works
// (gateway/paths/README.md).
struct PathRule
{
    std::string Name;  // with the characters of a node name, each once
    // As in GatewayConfig, for this path alone.
    std::string Transport{};  // empty: that of the gateway
    std::vector<std::string> Interfaces{};
    std::vector<std::string> Peers{};
    bool Multicast = true;
    RadioSettings Radio{};
    std::optional<SecuritySettings> Security{};  // unset: that of the gateway
    int Line = 0;
};

// Most paths of a gateway.
inline constexpr std::size_t MostPaths = 8;

// A tool, as the program `rabit`: it looks, asks and sends, and nobody counts on it. It publishes and accepts
// nothing, the others do not list it, and keep nothing of it once it has gone. README.md (A tool is no node
// of the fleet) has the exact rules.
struct ToolSettings
{
    // The nodes whose announcements it asks for; `*` and `?` are wildcards. Of other nodes the tool knows
    // only that they are there, and receives nothing.
    std::vector<std::string> AsksOf = {"*"};
};

// A recording that is written only when a trigger occurs: it covers the time Before the trigger and the time
// After it. Another trigger meanwhile prolongs it.
struct BlackBoxSettings
{
    std::chrono::milliseconds Before{60'000};  // 1 s to 1 h; as much of it as RecordSettings::Memory holds
    std::chrono::milliseconds After{10'000};   // likewise
    // The triggers, besides RecorderManager::WriteBlackBox.
    std::vector<std::string> Messages{};  // a post of one of these local messages (names or patterns)
    std::vector<std::string> Queues{};    // a message of another node for one of these queues (names or
                                          // patterns)
    bool Outcomes = true;                 // a message for a queue elsewhere that is not delivered
    bool Problems = false;                // a problem in Gateway/Fleet that was not there before
};

// Which data of this process is recorded, and where (recording/README.md). Read by the program's
// RecorderManager, which Rabit::RunNode makes.
struct RecordSettings
{
    std::string Folder;
    // Local messages, by name or pattern with `*` and `?`; a message that both lists name is not recorded.
    std::vector<std::string> Messages = {"*"};
    std::vector<std::string> Except{};
    bool Queues = true;  // messages to and from queues of other nodes
    // Managers, by name or pattern. Each of their units of work is recorded with its inputs and effects, so
    // that it can be run again.
    std::vector<std::string> Steps{};
    std::uint64_t SplitSize = std::uint64_t{1} << 30;  // a file is ended at this size, 1 MB to 1 TB
    std::chrono::milliseconds SplitTime{600'000};      // or after this time, 1 s to 24 h
    // Bytes of this node's files that are kept, earlier recordings included; beyond it the oldest is removed.
    // 0: none is removed for it.
    std::uint64_t Keep = 0;
    // Bytes of the disk that stay free: the oldest files of this recording are removed, then it pauses.
    std::uint64_t Free = std::uint64_t{1} << 30;
    std::uint64_t Memory = 64U << 20;            // bytes that may wait for the disk, 1 MB to 64 GB
    std::optional<BlackBoxSettings> BlackBox{};  // set: a recording is written only on a trigger
    // Messages of other nodes, each of a `subscribe` rule, without wildcards: the posts that are missing here
    // are requested from the recordings of these nodes (gateway/backfill/README.md).
    std::vector<std::string> Backfill{};
    std::chrono::milliseconds BackfillLast{3'600'000};  // older posts are not requested, 1 s to 24 h
    // Nodes that may request posts of published messages from this recording; `*` and `?` are wildcards.
    // Unset: everybody without keys, nobody with keys.
    std::optional<std::vector<std::string>> BackfillTo{};
    int Line = 0;
};

// The files of one folder, which other nodes may fetch (`rabit fetch`). Files in folders below it and
// symbolic links are not sent.
struct FetchSettings
{
    std::string Folder;
    std::vector<std::string> From;  // nodes that may fetch, at least one; `*` and `?` are wildcards
    int Line = 0;
};

// The nodes that agree among themselves: on claims, which one of them has at a time (Claims), and on a table
// (SharedTable). All of them need the same members and the same lease.
struct AgreementRule
{
    std::vector<std::string> Members;  // names of nodes, 1 to 64, this one among them, in any order
    // How long a claim outlives the last answer of a majority: four of the slowest beats at least, 60 s at
    // most. The slowest beat is 500 ms, or with a budget RadioSettings::SlowestBeat.
    std::chrono::milliseconds Lease{2000};
    int Line = 0;
};

// Most members of an agreement.
inline constexpr std::size_t MostAgreementMembers = 64;

// Everything a gateway is told. Fill it in code, or load it with LoadGatewayConfig.
struct GatewayConfig
{
    std::string Node;  // 1 to 64 of the characters A-Z a-z 0-9 _ . -
    // Name of this gateway in its process, with the characters of a node name. Its manager has this name, and
    // its local message is `<Name>/Fleet`. Two gateways in one workspace, for instance for a radio and for a
    // LAN, need two.
    std::string Name = "Gateway";
    int Domain = 0;  // DDS domain, 0 to 232
    std::string Transport = "fastdds";

    // Network settings; TransportSettings says what each one means.
    std::vector<std::string> Interfaces;
    std::vector<std::string> Peers;
    bool Multicast = true;
    std::size_t MaxDatagram = 1400;
    bool SharedMemory = false;
    std::chrono::milliseconds Lease{30000};
    // After how long without a beat another node is LOST, on each path. Three times the time between beats to
    // 1 h. If a node announces rarer beats, three of these: it is STALE first. Unset: seven times the time
    // between the node's beats.
    std::optional<std::chrono::milliseconds> LostAfter{};
    std::string BackendConfig;

    // Set: with keys. Not set: every program that reaches the network takes part.
    std::optional<SecuritySettings> Security{};

    RadioSettings Radio;

    // Empty: one path, with the settings above. Else each has its own Interfaces, Peers, Multicast and Radio,
    // and those above must not be set.
    std::vector<PathRule> Paths{};

    // Folder of the incarnation counter; empty: none, the wall clock numbers the incarnations of this node.
    std::string StateDir;

    std::vector<PublishRule> Publish;
    std::vector<SubscribeRule> Subscribe;
    std::vector<AcceptRule> Accept;
    std::vector<SendRule> Send;
    std::vector<ForeignRule> Foreign;
    std::vector<PanelRule> Panels{};  // for `rabit foxglove`
    // The nodes whose problems are requested in words, for NodeStatus::problem_texts, while they have any;
    // `*` and `?` are wildcards. The number of their problems is known without it.
    std::vector<std::string> ProblemsOf{};

    // Values of the program's own.
    NodeParameters Parameters{};

    // Set: this is recorded.
    std::optional<RecordSettings> Record{};
    // Set: other nodes may fetch files of this one.
    std::optional<FetchSettings> Fetch{};
    // Set: this node agrees with others.
    std::optional<AgreementRule> Agreement{};
    // Shared by the Claims, the SharedTables and the gateway of this configuration; they make it.
    std::shared_ptr<AgreementHub> Agreed{};
    // Observes queue messages and clocks; may be null. Only in code.
    std::shared_ptr<GatewayTap> Tap{};

    // Set: this node is a tool. Only in code.
    std::optional<ToolSettings> Tool{};
    // True if this node plays a recording. Its beats say so, and the others show it (NodeStatus::replay).
    // Only in code.
    bool Replay = false;

    // False: this node sends neither its problems in words nor its log to those that request them.
    bool Reports = true;

    // For error messages: the file of the configuration, and the lines of its top-level keys and of the keys
    // in `security`, `radio`, `record`, `fetch` and `agreement` (`radio.budget`). Empty: made in code.
    std::string File;
    std::map<std::string, int> Lines;
};

// The configuration of each path: the gateway's, with the network settings of the path, and with the path
// alone under Paths. Of a gateway without Paths its own.
std::vector<GatewayConfig> PathConfigsOf(const GatewayConfig &config);
// True if some path has keys.
bool SomePathHasKeys(const GatewayConfig &config);

// Has the gateway use these interfaces alone, in place of those of the configuration. Of several paths one
// remains, with its keys, budget and peers: the first that names one of the interfaces, else the first.
void UseInterfaces(const std::vector<std::string> &interfaces, GatewayConfig &config);

// Checks ranges, names used twice, entries that contradict each other or are never used, and that every type
// is linked into this process. Throws ConfigError. The constructor of GatewayManager calls it; call it
// earlier to fail earlier.
void ValidateGatewayConfig(const GatewayConfig &config);

// Checks that config.Transport is among the backends that this process has. Throws ConfigError if not. If the
// name is only in `known`, the error says that the backend was left out of the build; otherwise it suggests
// the nearest name.
void ValidateTransportName(const GatewayConfig &config, const std::vector<std::string> &available,
                           const std::vector<std::string> &known = {});

}  // namespace Rabit
