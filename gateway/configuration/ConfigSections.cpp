#include "configuration/ConfigSections.h"

#include <rabit/gateway/QosProfileWords.h>

#include <algorithm>
#include <stdexcept>

#include "names/TrafficClassWords.h"

namespace Rabit
{
namespace
{

constexpr bool RequiredKey = true;

// "`command`, `state` or `bulk`"
std::string OneOf(const std::vector<std::string> &words)
{
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
    {
        const bool isLast = i + 1 == words.size();
        text += (i == 0 ? "`" : isLast ? " or `" : ", `") + words[i] + "`";
    }
    return text;
}

ConfigSection WholeFileSection()
{
    return {
        "",
        "the configuration",
        "The keys at the top level of the file. Only `node` is needed.",
        {{"node", "1 to 64 of `A-Z a-z 0-9 _ . -`", "", "uav1",
          "Name of this node, unique in its domain. The option `--node` of a program replaces it."},
         {"name", "1 to 64 of `A-Z a-z 0-9 _ . -`", "Gateway", "Lan",
          "Name of this gateway in its process. Its local message is `<name>/Fleet`. Two gateways in one "
          "workspace, for instance one for a radio and one for a LAN, need two names."},
         {"domain", "0 to 232", "0", "7", "DDS domain. Nodes of different domains do not hear each other."},
         {"transport", "a DDS implementation of this build, as `fastdds` or `cyclonedds`", "fastdds",
          "cyclonedds", "DDS implementation of this node. A fleet may mix them."},
         {"interfaces", "list of names or addresses", "", "[wlan0]",
          "Network interfaces to use. The node waits for them. Default: all."},
         {"peers", "list of addresses", "", "[10.0.0.2]",
          "Addresses of other nodes where multicast does not reach them. Default: none."},
         {"multicast", "`on` or `off`", "on", "off", "`off`: nodes are found by `peers` alone."},
         {"max_datagram", "1000 to 65000, bytes", "1400", "65000",
          "Largest UDP datagram. Keep it below the MTU of a radio; 65000 suits wires and loopback."},
         {"shared_memory", "`on` or `off`", "off", "on",
          "Lets the DDS implementation use shared memory between processes of one machine."},
         {"lease", "time from 200ms; more than 5min count as 5min", "30s", "10s",
          "DDS forgets a participant that is silent for this time. Nodes are LOST long before, by their "
          "beats. Default with a `budget`: 90s."},
         {"lost_after",
          "time up to 1h, three beats at least: 1500ms, with a `budget` 3 times `slowest_beat`, with `paths` "
          "that of the path with the most frequent beats",
          "", "5s",
          "Another node is LOST after this time without a beat from it, but not before three of its "
          "beats are missing. Default: seven times the time between its beats (3.5s)."},
         {"backend_config", "path of a file", "", "vendor.xml",
          "Settings of the DDS implementation in its own format, for what no key here says."},
         {"state_dir", "path of a folder", "", "/var/lib/rabit",
          "Keeps the counter of incarnations over restarts. Default: none; the wall clock numbers the "
          "incarnations, which needs a clock that never goes back."},
         {"security", "mapping", "", "{keys: keys/uav1}",
          "Keys of the fleet. Default: none; every program that reaches the network takes part."},
         {"radio", "mapping", "", "{budget: 5kB/s}", "Limits on what this node puts on the air."},
         {"paths", "list of mappings", "", "[{name: mesh, interfaces: [wlan0]}]",
          "Several networks to the same nodes, the best first. With it `interfaces`, `peers`, `multicast` "
          "and `radio` stand in each path."},
         {"fetch", "mapping", "", "{folder: /var/lib/rabit/recordings, from: [ground]}",
          "Files that other nodes may fetch with `rabit fetch`. Default: none."},
         {"agreement", "mapping", "", "{members: [uav1, uav2, ground]}",
          "The nodes that agree on claims, which one of them has at a time, and on a shared table. Default: "
          "none."},
         {"record", "mapping", "", "{folder: /var/lib/rabit/recordings}",
          "Records the messages of this process. Default: nothing is recorded."},
         {"publish", "list of mappings", "", "[{message: Pose, type: Uav::Pose}]",
          "Local messages that other nodes may read."},
         {"subscribe", "list of mappings", "", "[{message: Pose, type: Uav::Pose}]",
          "Messages of other nodes, which appear here as `<node>/<message>`."},
         {"accept", "list of mappings", "", "[{queue: MissionControl, types: [Uav::Goto]}]",
          "Local queues into which other nodes may put messages."},
         {"send", "list of mappings", "", "[{queue: MissionControl, expire: 5s}]",
          "Limits for messages to queues of other nodes. Needed only to change the defaults."},
         {"foreign", "list of mappings", "",
          "[{subscribe: rt/chatter, type: std_msgs::msg::String, as: Chatter}]",
          "Topics of programs that are no nodes: ROS 2, PX4, any DDS program. With `paths`, they are on the "
          "first one."},
         {"foxglove", "list of mappings", "", "[{message: Pose, as: foxglove.Log, fields: {message: text}}]",
          "Sources of a viewer's map, pictures and log, for `rabit foxglove`. Nodes ignore it."},
         {"problems_of", "list of nodes; `*` and `?` are wildcards", "", "[\"uav*\"]",
          "Nodes whose own problems `Gateway/Fleet` tells in words (`problem_texts`). Default: none; only "
          "the number of their problems is known."},
         {"reports", "`on` or `off`", "on", "off",
          "`off`: this node sends its problems in words, its foreign topics and its log to nobody."},
         {"parameters", "mapping of any keys", "", "{spacing_m: 20, leader: uav1}",
          "Values of the program itself, which reads them by `config.Parameters`. A name that the program "
          "does not read is an error."}}};
}

ConfigSection SecuritySection()
{
    return {"security",
            "the section `security`",
            "Keys keep unauthenticated peers out of the fleet. Everything is encrypted and signed.",
            {{"keys", "path of a folder", "", "keys/uav1", "The node's folder, which `rabit keys add` made.",
              RequiredKey}}};
}

ConfigSection RadioSection()
{
    return {
        "radio",
        "the section `radio`",
        "Without this section the rate of the node follows the capacity of the channel.",
        {{"budget", "`auto`, or a rate such as `1500B/s`, `5kB/s`, `2MB/s`", "auto", "5kB/s",
          "Bytes that this node may put on the air in any second, all headers included."},
         {"slowest_beat", "time from 500ms to 60s", "2s", "5s",
          "Longest time between two beats, with a small budget. Other nodes see this node STALE after three "
          "times this time, and LOST after seven times."}}};
}

ConfigSection PathsSection()
{
    return {
        "paths",
        "a `paths` entry",
        "One of several networks to the same nodes, such as a mesh radio and a modem; the best comes first.",
        {{"name", "1 to 64 of `A-Z a-z 0-9 _ . -`", "", "mesh", "Name of the path.", RequiredKey},
         {"transport", "a DDS implementation of this build, as `fastdds` or `cyclonedds`", "", "cyclonedds",
          "Default: that of the gateway."},
         {"interfaces", "list of names or addresses", "", "[wlan0]", "Network interfaces. Default: all."},
         {"peers", "list of addresses", "", "[10.0.0.2]", "Addresses of other nodes. Default: none."},
         {"multicast", "`on` or `off`", "on", "off", "`off`: nodes are found by `peers` alone."},
         {"radio", "mapping", "", "{budget: 5kB/s}", "As the section `radio`, for this path alone."},
         {"security", "mapping", "", "{keys: keys/uav1}",
          "As the section `security`. Default: that of the gateway."}}};
}

ConfigSection FetchSection()
{
    return {
        "fetch",
        "the section `fetch`",
        "Files of one folder that other nodes may fetch. Folders below it and symbolic links are not sent.",
        {{"folder", "path of a folder", "", "/var/lib/rabit/recordings", "The folder.", RequiredKey},
         {"from", "list of nodes; `*` and `?` are wildcards", "", "[ground]", "Nodes that may fetch.",
          RequiredKey}}};
}

ConfigSection AgreementSection()
{
    return {"agreement",
            "the section `agreement`",
            "The nodes that agree on claims, which one of them has at a time, and on a shared table. All "
            "members need the same list and the same lease.",
            {{"members", "list of nodes, 1 to 64", "", "[uav1, uav2, ground]",
              "The nodes that vote, this one among them. A majority of them must hear each other. An odd "
              "number is best.",
              RequiredKey},
             {"lease", "time from four of the slowest beats to 60s", "2s", "4s",
              "A node without a majority loses its claims within this time, and others get them somewhat "
              "later. The slowest beat is 500ms, or `radio: slowest_beat` with a budget."}}};
}

ConfigSection RecordSection()
{
    return {
        "record",
        "the section `record`",
        "What is recorded of this process, and where. The files are MCAP, which Foxglove opens.",
        {{"folder", "path of a folder", "", "/var/lib/rabit/recordings", "It is made if it is missing.",
          RequiredKey},
         {"messages", "list of names; `*` and `?` are wildcards", "[\"*\"]", "[Pose, \"uav2/*\"]",
          "Local messages by their names, messages of other nodes as `uav2/Pose`."},
         {"except", "list of names; `*` and `?` are wildcards", "", "[\"*/CameraView\"]",
          "Messages that are left out."},
         {"queues", "`on` or `off`", "on", "off", "Messages to and from queues of other nodes."},
         {"steps", "list of managers; `*` and `?` are wildcards", "", "[MissionControl]",
          "Managers whose units of work are recorded, so that they can run again afterwards."},
         {"split_size", "size from 1MB to 1TB", "", "500MB", "A file is ended at this size. Default: 1 GiB."},
         {"split_time", "time from 1s to 1440min", "10min", "5min", "A file is ended after this time."},
         {"keep", "size, or 0", "0", "20GB",
          "Size of all files of this node, earlier flights included; beyond it the oldest is removed. 0: no "
          "limit."},
         {"free", "size, or 0", "", "2GB",
          "Space of the disk that stays free: the oldest files of this recording are removed, then recording "
          "pauses. Default: 1 GiB."},
         {"memory", "size from 1MB to 64GB", "", "100MB",
          "Bytes that may wait for the disk. Further messages are dropped and counted. Default: 64 MiB."},
         {"backfill", "list of messages under `subscribe`", "", "[Pose]",
          "Messages of other nodes whose missing posts are requested from the recordings there."},
         {"backfill_last", "time from 1s to 1440min", "60min", "10min", "Older posts are not requested."},
         {"backfill_to", "list of nodes; `*` and `?` are wildcards", "", "[ground]",
          "Nodes that may request posts from this recording. Default: everybody without keys, nobody with "
          "keys."},
         {"black_box", "mapping", "", "{before: 60s}",
          "With it, files are written for events only. Default: everything is written."}}};
}

ConfigSection BlackBoxSection()
{
    return {"record.black_box",
            "the section `black_box`",
            "Each event writes a file with the time before it and after it.",
            {{"before", "time from 1s to 60min", "60s", "30s",
              "Time before the event, as far as a buffer of the size `memory` holds it."},
             {"after", "time from 1s to 60min", "10s", "20s", "Time after the event."},
             {"messages", "list of names; `*` and `?` are wildcards", "", "[Alarm]",
              "Event: a post of one of these local messages."},
             {"queues", "list of names; `*` and `?` are wildcards", "", "[MissionControl]",
              "Event: a message that another node put into one of these queues."},
             {"outcomes", "`on` or `off`", "on", "off", "Event: a message of this node was not delivered."},
             {"problems", "`on` or `off`", "off", "on", "Event: a new problem in `Gateway/Fleet`."}}};
}

ConfigKey ClassKey(const std::string &byDefault)
{
    return {"class", OneOf(TrafficClassWords()), byDefault, "bulk", "Priority where the radio is full."};
}

ConfigKey WeightKey()
{
    return {"weight", "number from 0.01 to 100", "1", "3", "Share among the messages of the same class."};
}

ConfigSection PublishSection()
{
    ConfigKey traffic = ClassKey("");
    traffic.Help += " Default: as `qos`.";
    return {"publish",
            "a `publish` entry",
            "A local message that other nodes may read.",
            {{"message", "1 to 200 of `A-Z a-z 0-9 _ . - : /`", "", "Pose",
              "Name of the local message, and of the DDS topic.", RequiredKey},
             {"type", "name of an IDL type", "", "Uav::Pose", "The type must be linked into the program.",
              RequiredKey},
             {"qos", OneOf(QosProfileWords), "state", "telemetry",
              "`state`: every reader gets the newest value, late ones too. `telemetry`: nothing is "
              "retransmitted, as a newer value comes soon."},
             {"max_rate", "number from 0 to 1000000, Hz", "0", "10",
              "Samples a second at most; posts in between are left out. 0: no limit."},
             traffic,
             WeightKey()}};
}

ConfigSection SubscribeSection()
{
    return {"subscribe",
            "a `subscribe` entry",
            "A message of other nodes. Each appears here as the local message `<node>/<message>`.",
            {{"message", "1 to 200 of `A-Z a-z 0-9 _ . - : /`", "", "Pose", "Name of the message there.",
              RequiredKey},
             {"type", "name of an IDL type", "", "Uav::Pose", "The type must be linked into the program.",
              RequiredKey},
             {"from", "list of nodes; `*` and `?` are wildcards", "[\"*\"]", "[\"uav*\"]",
              "Nodes that it is read from."},
             {"qos", OneOf(QosProfileWords), "", "telemetry", "Default: as the publisher announces."}}};
}

ConfigSection AcceptSection()
{
    return {"accept",
            "an `accept` entry",
            "A local queue into which other nodes may put messages.",
            {{"queue", "1 to 200 of `A-Z a-z 0-9 _ . - : /`", "", "MissionControl",
              "Name of the queue; a manager's own queue has the manager's name.", RequiredKey},
             {"types", "list of IDL types", "", "[Uav::Goto, Uav::GoHome]",
              "Types of the messages that it takes.", RequiredKey},
             {"from", "list of nodes; `*` and `?` are wildcards", "[\"*\"]", "[ground, \"uav*\"]",
              "Nodes that may send."}}};
}

ConfigSection SendSection()
{
    return {"send",
            "a `send` entry",
            "Limits for messages to queues of other nodes. The first entry that fits a link holds.",
            {{"to", "node; `*` and `?` are wildcards", "\"*\"", "uav1", "Destination node."},
             {"queue", "queue; `*` and `?` are wildcards", "\"*\"", "MissionControl", "Queue there."},
             {"capacity", "1 to 1000000", "1000", "100",
              "Messages that may wait. A further one is refused at once."},
             {"capacity_bytes", "1 to 1099511627776", "16777216", "1000000", "Bytes that may wait."},
             {"expire", "time, or 0s", "0s", "5s",
              "A message older than this is never delivered. 0s: no message is too old. Give commands a "
              "limit."},
             {"window", "1 to 256", "256", "16", "Messages under way at once."},
             {"redeliver_in_doubt", "`on` or `off`", "off", "on",
              "After a restart of the receiver, sends the messages without a known outcome again, marked "
              "(`IsRedelivered`)."},
             ClassKey("command"),
             WeightKey()}};
}

ConfigSection ForeignSection()
{
    return {
        "foreign",
        "a `foreign` entry",
        "A topic of programs that are no nodes. An entry has either `subscribe` or `publish`.",
        {{"subscribe", "name of a topic", "", "rt/chatter", "The topic that is read."},
         {"publish", "name of a local message or queue", "", "Setpoint",
          "The local message that is written, or the queue whose messages are written."},
         {"type", "name of an IDL type", "", "std_msgs::msg::String",
          "The type must be linked into the program.", RequiredKey},
         {"names", "`plain` or `ros2`", "plain", "ros2",
          "`ros2`: names are changed as ROS 2 does it, so `/chatter` is `rt/chatter` on the wire."},
         {"reliability", "`best_effort`, `reliable` or, for `subscribe`, `as_found`", "", "best_effort",
          "Default: `as_found` (the QoS that all writers offer) for `subscribe`, `reliable` for `publish`."},
         {"durability", "`volatile`, `transient_local` or, for `subscribe`, `as_found`", "", "volatile",
          "Default: `as_found` for `subscribe`, `volatile` for `publish`."},
         {"as", "name of a local message or queue", "", "Chatter", "Only with `subscribe`, which needs it."},
         {"each", "`latest` or `queue`", "latest", "queue",
          "`latest`: the newest sample is the message, or the newest value is written. `queue`: each sample "
          "goes into the queue, or each message for the queue is written."},
         {"stale_after", "time, or 0s", "", "2s",
          "Only with `subscribe`. STALE if nothing came for this time. Default: never."},
         {"age", "`arrival` or `source_time`", "arrival", "source_time",
          "Only with `subscribe`. The moment from which the age of a sample counts."},
         {"capacity", "1 to 1000000", "1000", "100",
          "Only with `each: queue`. Samples that may wait for room in the queue, or messages that may wait "
          "to "
          "be written."},
         {"capacity_bytes", "1 to 1099511627776", "16777216", "1000000",
          "Only with `each: queue`. Serialized bytes that may wait. A larger sample waits only alone."},
         {"topic", "name of a topic", "", "rt/fmu/in/trajectory_setpoint",
          "Only with `publish`. Default: the name of the message."},
         {"depth", "1 to 10000", "", "1",
          "Only with `publish`. Samples that are kept for retransmission and late readers. Default: 10, with "
          "`each: queue` 1000."},
         {"max_rate", "number from 0 to 1000000, Hz", "0", "50",
          "Only with `publish`. Samples a second at most. 0: no limit."}}};
}

ConfigSection FoxgloveSection()
{
    return {"foxglove",
            "a `foxglove` entry",
            "A message that a viewer shows on its map, as a picture or in its log.",
            {{"message", "name of a message", "", "Pose", "The message, of any node.", RequiredKey},
             {"as", "`foxglove.LocationFix`, `foxglove.CompressedImage` or `foxglove.Log`", "",
              "foxglove.LocationFix", "The schema that the viewer knows.", RequiredKey},
             {"fields", "mapping", "", "{latitude: latitude_deg, longitude: longitude_deg}",
              "Fields of the schema, and the member of the message for each.", RequiredKey}}};
}

ConfigKey PanelField(const std::string &name, const std::string &example, bool isRequired)
{
    return {name, "name of a member", "", example, "", isRequired};
}

// The sections named after the schemas of the viewer.
std::vector<ConfigSection> PanelFieldSections()
{
    return {
        {"foxglove.LocationFix",
         "`fields` of foxglove.LocationFix",
         "A place on the map.",
         {PanelField("latitude", "latitude_deg", RequiredKey),
          PanelField("longitude", "longitude_deg", RequiredKey),
          PanelField("altitude", "altitude_m", !RequiredKey), PanelField("frame_id", "frame", !RequiredKey)}},
        {"foxglove.CompressedImage",
         "`fields` of foxglove.CompressedImage",
         "A picture.",
         {PanelField("data", "data", RequiredKey), PanelField("format", "format", RequiredKey),
          PanelField("frame_id", "frame", !RequiredKey)}},
        {"foxglove.Log",
         "`fields` of foxglove.Log",
         "A line of the log.",
         {PanelField("message", "text", RequiredKey), PanelField("name", "origin", !RequiredKey),
          PanelField("level", "severity", !RequiredKey)}}};
}

std::vector<ConfigSection> AllSections()
{
    std::vector<ConfigSection> sections = {
        WholeFileSection(), PublishSection(),   SubscribeSection(), AcceptSection(),  SendSection(),
        SecuritySection(),  RadioSection(),     PathsSection(),     RecordSection(),  BlackBoxSection(),
        FetchSection(),     AgreementSection(), ForeignSection(),   FoxgloveSection()};
    const std::vector<ConfigSection> fields = PanelFieldSections();
    sections.insert(sections.end(), fields.begin(), fields.end());
    return sections;
}

}  // namespace

std::vector<std::string> ConfigSection::Names() const
{
    std::vector<std::string> names;
    for (const ConfigKey &key : Keys)
    {
        names.push_back(key.Name);
    }
    return names;
}

const std::vector<ConfigSection> &ConfigSections()
{
    static const std::vector<ConfigSection> sections = AllSections();
    return sections;
}

const ConfigSection &ConfigSectionAt(const std::string &path)
{
    const std::vector<ConfigSection> &sections = ConfigSections();
    const auto found = std::find_if(sections.begin(), sections.end(),
                                    [&path](const ConfigSection &section) { return section.Path == path; });
    if (found == sections.end())
    {
        throw std::out_of_range("there is no section `" + path + "` of a configuration");
    }
    return *found;
}

}  // namespace Rabit
