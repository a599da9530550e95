#pragma once

#include <rabit/gateway/ForeignRule.h>
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
class GatewayTap;

// How a mirrored message travels. Both ends of a message must agree; a subscription takes over what the
// publisher announces unless it names one itself.
enum class QosProfile
{
    // The last value reaches everybody, late joiners too; who lacks it asks for it: for what must be known.
    State,
    // Nothing is repeated: for what is soon replaced by a newer value.
    Telemetry
};

// A local message that other nodes may see.
struct PublishRule
{
    std::string Message;                 // local message name = topic name
    std::string Type;                    // IDL name
    QosProfile Qos = QosProfile::State;  //
    double MaxRate = 0.0;                // samples a second at most, up to 1e6; 0: no limit
    // How important it is where the air is thin, any but Presence; unset: State or Telemetry, as the QoS.
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
    std::vector<std::string> From = {"*"};  // names of the nodes that may; `*` and `?` are wildcards
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
    bool RedeliverInDoubt = false;          // send again, flagged, what a restart left in doubt
    // How important the messages are where the air is thin, any but Presence.
    TrafficClass Class = TrafficClass::Command;
    double Weight = 1.0;  // among those of its class, 0.01 to 100
    int Line = 0;
};

// What this node may put on the air.
struct RadioSettings
{
    // Bytes a second, IP headers and all above included, in whichever second; from SmallestBudget to 1e9.
    // Unset (`auto`): the rate follows what the air carries, and is unlimited where that does not limit it.
    std::optional<double> Budget{};
    // With a budget a node says that it is there as often as a twentieth of the budget allows, but every 500
    // ms at most and at least this often, 500 ms to 60 s. It is STALE after three times that, LOST after
    // seven. Without a budget it does so every 500 ms.
    std::chrono::milliseconds SlowestBeat{2000};
};

// Below this budget a node could not say in time that it is there and anything else; bytes a second.
double SmallestBudget(std::chrono::milliseconds slowestBeat);

// How much a fleet with keys is protected; all of it alike, or they do not hear each other.
enum class SecurityLevel
{
    Sign,    // everybody can read what is said, nobody can forge it
    Encrypt  // nor can it be read
};

// DDS Security: who has no keys of this fleet is neither heard nor answered (keys/README.md).
struct SecuritySettings
{
    std::string Keys;  // the node's folder, which `rabit keys add` made
    SecurityLevel Level = SecurityLevel::Encrypt;
};

// A node that looks, asks and sends, and on which nobody counts, as the program `rabit`: it publishes and
// accepts nothing, the others do not list it, and keep nothing of it once it has gone. README.md (A tool is
// no node of the fleet) says what exactly holds.
struct ToolSettings
{
    // The nodes whose announcements it asks for; `*` and `?` are wildcards. Of the others it knows only that
    // they are there: nothing of them is received.
    std::vector<std::string> AsksOf = {"*"};
};

// A recording that is written only when something happens: then what was there in the time before, and all
// until that time after it. What happens meanwhile prolongs it.
struct BlackBoxSettings
{
    std::chrono::milliseconds Before{60'000};  // 1 s to 1 h; as much of it as RecordSettings::Memory holds
    std::chrono::milliseconds After{10'000};   // likewise
    // What has it written, besides RecorderManager::WriteBlackBox.
    std::vector<std::string>
        Messages{};  // a post of one of these local messages; patterns, as all that follows
    std::vector<std::string> Queues{};  // a message that is put into one of these queues from elsewhere
    bool Outcomes = true;               // a message for a queue elsewhere that is not delivered
    bool Problems = false;              // a problem in Gateway/Fleet that was not there before
};

// What of this process is recorded, and where to (recording/README.md). It is for the program's
// RecorderManager: Rabit::RunNode makes one.
struct RecordSettings
{
    std::string Folder;
    // Local messages, by name or pattern with `*` and `?`; what both lists name is not recorded.
    std::vector<std::string> Messages = {"*"};
    std::vector<std::string> Except{};
    bool Queues = true;                                // messages to and from queues of other nodes
    // Managers, by name or pattern, whose every unit of work is recorded with all that it read and did, so
    // that it can be run again.
    std::vector<std::string> Steps{};
    std::uint64_t SplitSize = std::uint64_t{1} << 30;  // a file is ended at so many bytes, 1 MB to 1 TB
    std::chrono::milliseconds SplitTime{600'000};      // or after so long, 1 s to 24 h
    std::uint64_t Keep = 0;                       // bytes of this node's files that are kept; 0: all that fit
    std::uint64_t Free = std::uint64_t{1} << 30;  // bytes of the disk that stay free
    std::uint64_t Memory = 64U << 20;             // bytes that may wait for the disk, 1 MB to 64 GB
    std::optional<BlackBoxSettings> BlackBox{};   // set: only when something happens
    int Line = 0;
};

// Everything a gateway is told. Fill it in code, or load it with LoadGatewayConfig.
struct GatewayConfig
{
    std::string Node;  // 1 to 64 of the characters A-Z a-z 0-9 _ . -
    // Of this gateway in its process, like a node name: its manager is called so, and its local message is
    // `<Name>/Fleet`. Two gateways in one workspace, for instance for a radio and for a LAN, need two.
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
    std::string BackendConfig;

    // Set: with keys. Not set: whoever reaches the network takes part.
    std::optional<SecuritySettings> Security{};

    RadioSettings Radio;

    // Folder of the incarnation counter; empty: none, the wall clock numbers the lives of this node.
    std::string StateDir;

    std::vector<PublishRule> Publish;
    std::vector<SubscribeRule> Subscribe;
    std::vector<AcceptRule> Accept;
    std::vector<SendRule> Send;
    std::vector<ForeignRule> Foreign;
    std::vector<PanelRule> Panels{};  // for `rabit foxglove`

    // Set: this is recorded.
    std::optional<RecordSettings> Record{};
    // Is told of queue messages and clocks; null: nobody is. Only in code.
    std::shared_ptr<GatewayTap> Tap{};

    // Set: this node is a tool. Only in code.
    std::optional<ToolSettings> Tool{};
    // Whether what this node posts was recorded before, and is played again. Its beats say so, and the others
    // show it (NodeStatus::replay). Only in code.
    bool Replay = false;

    // For error messages: the file it came from and the line of each of its top-level keys, and of those of
    // the sections `security`, `radio` and `record` (`radio.budget`); empty: made in code.
    std::string File;
    std::map<std::string, int> Lines;
};

// Checks ranges, names used twice, entries that contradict each other or are never used, and that every type
// is linked into this process. Throws ConfigError. The constructor of GatewayManager calls it; call it
// earlier to fail earlier.
void ValidateGatewayConfig(const GatewayConfig &config);

// Checks that config.Transport is among the backends that this process has. Throws ConfigError: one that is
// only in `known` was left out of the build, for another one it names the nearest.
void ValidateTransportName(const GatewayConfig &config, const std::vector<std::string> &available,
                           const std::vector<std::string> &known = {});

}  // namespace Rabit
