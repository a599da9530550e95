#include <rabit/gateway/LoadGatewayConfig.h>

#include <rabit/base/WithoutByteOrderMark.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "configuration/ConfigSections.h"
#include "configuration/ForeignEntries.h"
#include "configuration/PanelEntries.h"
#include "configuration/ParameterSection.h"
#include "configuration/ValidateGatewayConfig.h"
#include "configuration/YamlMap.h"
#include "names/TrafficClassWords.h"

namespace Rabit
{
namespace
{

// A configuration is a page of text; a larger file is not one.
constexpr std::size_t LargestFile = 1u << 20;

std::string ReadFile(const std::string &file)
{
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    if (!stream || !(text << stream.rdbuf()))
    {
        const std::string why = errno != 0 ? std::generic_category().message(errno) : "it is empty";
        throw ConfigError(file, 0, "cannot read the configuration: " + why);
    }
    if (text.str().size() > LargestFile)
    {
        throw ConfigError(file, 0, "the configuration is larger than 1 MiB");
    }
    return text.str();
}

// The line in which a second document begins that has something in it; 0: there is none. A line that begins
// with
// `---` or `...` and a blank, or is only that, is a marker wherever it stands (YAML 1.2, 9.1.2).
int SecondDocument(const std::string &text)
{
    std::istringstream lines(text);
    bool hasBegun = false;  // the first document
    bool hasEnded = false;
    int marker = 0;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number)
    {
        const bool isMarker = line.starts_with("---") || line.starts_with("...");
        if (isMarker && (line.size() == 3 || line.find_first_of(" \t\r") == 3))
        {
            hasEnded = hasEnded || hasBegun;
            hasBegun = hasBegun || line[0] == '-';
            marker = number;
            line.erase(0, 3);
        }
        const std::size_t first = line.find_first_not_of(" \t\r");
        const bool isDirective = first == 0 && line[0] == '%' && (hasEnded || !hasBegun);
        if (first == std::string::npos || line[first] == '#' || isDirective)
        {
            continue;
        }
        if (hasEnded)
        {
            return marker;
        }
        hasBegun = true;
    }
    return 0;
}

YAML::Node Parse(const std::string &file, const std::string &content)
{
    const std::string text(WithoutByteOrderMark(content));
    try
    {
        const YAML::Node first = YAML::Load(text);
        if (const int line = SecondDocument(text); line > 0)
        {
            throw ConfigError(file, line, "a second document: a configuration is one");
        }
        return first;
    }
    catch (const YAML::Exception &problem)
    {
        throw ConfigError(file, problem.mark.line + 1, "not YAML: " + problem.msg);
    }
}

void ReadNetwork(const YamlMap &map, GatewayConfig &config)
{
    map.Read("domain", config.Domain, 0, 232);
    map.Read("transport", config.Transport);
    map.Read("interfaces", config.Interfaces);
    map.Read("peers", config.Peers);
    map.Read("multicast", config.Multicast);
    map.Read("max_datagram", config.MaxDatagram, TransportSettings::SmallestDatagram,
             TransportSettings::LargestDatagram);
    map.Read("shared_memory", config.SharedMemory);
    map.Read("lease", config.Lease);
    if (map.Has("lost_after"))
    {
        map.Read("lost_after", config.LostAfter.emplace());
    }
    map.Read("backend_config", config.BackendConfig);
    map.Read("state_dir", config.StateDir);
}

// The section at that path; empty if it is missing. The lines of its keys are noted as `path.key`, after the
// place of the mapping that it is in.
std::optional<YamlMap> Section(const YamlMap &map, const std::string &path, GatewayConfig &config,
                               const std::string &place = "")
{
    auto section = map.Map(path.substr(path.rfind('.') + 1), ConfigSectionAt(path));
    for (const auto &[name, line] : section ? section->Lines() : std::map<std::string, int>())
    {
        config.Lines[place + path + "." + name] = line;
    }
    return section;
}

// The entries of the list at that top-level key.
std::vector<YamlMap> Entries(const YamlMap &map, const std::string &key)
{
    return map.Maps(key, ConfigSectionAt(key));
}

// The sections of a path stand at `place` of the file, those of a gateway at its top.
void ReadSecurity(const YamlMap &map, const std::string &place, GatewayConfig &config,
                  std::optional<SecuritySettings> &settings)
{
    // Files for former versions have it.
    if (const auto any = map.MapOfAnyKeys("security", ConfigSectionAt("security").Title);
        any && any->Has("level"))
    {
        any->Fail(any->Line("level"), "with keys everything is encrypted and signed; remove `level`");
    }
    if (const auto security = Section(map, "security", config, place))
    {
        settings.emplace();
        security->Read("keys", settings->Keys);
    }
}

void ReadRadio(const YamlMap &map, const std::string &place, GatewayConfig &config, RadioSettings &settings)
{
    if (const auto radio = Section(map, "radio", config, place))
    {
        radio->ReadByteRate("budget", settings.Budget);
        radio->Read("slowest_beat", settings.SlowestBeat);
    }
}

void ReadPaths(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : Entries(map, "paths"))
    {
        PathRule path;
        path.Line = entry.Line();
        entry.Read("name", path.Name);
        entry.Read("transport", path.Transport);
        entry.Read("interfaces", path.Interfaces);
        entry.Read("peers", path.Peers);
        entry.Read("multicast", path.Multicast);
        const std::string place = "paths." + path.Name + ".";
        for (const auto &[key, line] : entry.Lines())
        {
            config.Lines[place + key] = line;
        }
        ReadRadio(entry, place, config, path.Radio);
        ReadSecurity(entry, place, config, path.Security);
        config.Paths.push_back(path);
    }
}

void ReadRecord(const YamlMap &map, GatewayConfig &config)
{
    const auto record = Section(map, "record", config);
    if (!record)
    {
        return;
    }
    RecordSettings settings;
    settings.Line = map.Line("record");
    record->Read("folder", settings.Folder);
    record->Read("messages", settings.Messages);
    record->Read("except", settings.Except);
    record->Read("queues", settings.Queues);
    record->Read("steps", settings.Steps);
    record->ReadByteSize("split_size", settings.SplitSize, RecordRanges::SplitSize);
    record->Read("split_time", settings.SplitTime);
    record->ReadByteSize("keep", settings.Keep, RecordRanges::Keep);
    record->ReadByteSize("free", settings.Free, RecordRanges::Free);
    record->ReadByteSize("memory", settings.Memory, RecordRanges::Memory);
    if (const auto box = Section(*record, "record.black_box", config))
    {
        BlackBoxSettings &black = settings.BlackBox.emplace();
        box->Read("before", black.Before);
        box->Read("after", black.After);
        box->Read("messages", black.Messages);
        box->Read("queues", black.Queues);
        box->Read("outcomes", black.Outcomes);
        box->Read("problems", black.Problems);
    }
    record->Read("backfill", settings.Backfill);
    record->Read("backfill_last", settings.BackfillLast);
    if (config.Lines.contains("record.backfill_to"))
    {
        record->Read("backfill_to", settings.BackfillTo.emplace());
    }
    config.Record = settings;
}

void ReadFetch(const YamlMap &map, GatewayConfig &config)
{
    if (const auto fetch = Section(map, "fetch", config))
    {
        FetchSettings &settings = config.Fetch.emplace();
        settings.Line = map.Line("fetch");
        fetch->Read("folder", settings.Folder);
        fetch->Read("from", settings.From);
    }
}

void ReadAgreement(const YamlMap &map, GatewayConfig &config)
{
    if (const auto agreement = Section(map, "agreement", config))
    {
        AgreementRule &rule = config.Agreement.emplace();
        rule.Line = map.Line("agreement");
        agreement->Read("members", rule.Members);
        agreement->Read("lease", rule.Lease);
    }
}

std::optional<TrafficClass> ReadClass(const YamlMap &entry)
{
    const int choice = entry.ReadChoice("class", TrafficClassWords());
    return choice < 0 ? std::nullopt : std::optional(ChosenClass(static_cast<std::size_t>(choice)));
}

void ReadPublish(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : Entries(map, "publish"))
    {
        PublishRule rule;
        rule.Line = entry.Line();
        entry.Read("message", rule.Message);
        entry.ReadType("type", rule.Type);
        entry.Read("max_rate", rule.MaxRate);
        rule.Class = ReadClass(entry);
        entry.Read("weight", rule.Weight);
        entry.Read("qos", QosProfileWords, rule.Qos);
        config.Publish.push_back(rule);
    }
}

void ReadSubscribe(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : Entries(map, "subscribe"))
    {
        SubscribeRule rule;
        rule.Line = entry.Line();
        entry.Read("message", rule.Message);
        entry.ReadType("type", rule.Type);
        entry.Read("from", rule.From);
        entry.Read<std::optional<QosProfile>, QosProfile>("qos", QosProfileWords, rule.Qos);
        config.Subscribe.push_back(rule);
    }
}

void ReadAccept(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : Entries(map, "accept"))
    {
        AcceptRule rule;
        rule.Line = entry.Line();
        entry.Read("queue", rule.Queue);
        entry.ReadTypes("types", rule.Types);
        entry.Read("from", rule.From);
        config.Accept.push_back(rule);
    }
}

void ReadSend(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : Entries(map, "send"))
    {
        SendRule rule;
        rule.Line = entry.Line();
        entry.Read("to", rule.To);
        entry.Read("queue", rule.Queue);
        entry.Read("capacity", rule.Capacity, 1, 1'000'000);
        entry.Read("capacity_bytes", rule.CapacityBytes, 1, std::size_t{1} << 40);
        entry.Read("expire", rule.Expire);
        entry.Read("window", rule.Window, 1, 256);
        entry.Read("redeliver_in_doubt", rule.RedeliverInDoubt);
        rule.Class = ReadClass(entry).value_or(rule.Class);
        entry.Read("weight", rule.Weight);
        config.Send.push_back(rule);
    }
}

YamlMap OpenText(const std::string &file, const std::string &text)
{
    return {file, Parse(file, text), ConfigSectionAt("")};
}

YamlMap OpenFile(const std::string &file)
{
    return OpenText(file, ReadFile(file));
}

void ReadName(const YamlMap &map, const std::string &nodeOverride, GatewayConfig &config)
{
    config.Lines = map.Lines();
    map.Read("node", config.Node);
    map.Read("name", config.Name);
    if (!nodeOverride.empty())
    {
        config.Node = nodeOverride;
    }
    if (config.Node.empty())
    {
        map.Require("node");
    }
}

GatewayConfig ConfigOf(const YamlMap &map, const std::string &file, const std::string &nodeOverride,
                       const TypeCheck &whyNoType)
{
    GatewayConfig config;
    config.File = file;
    ReadName(map, nodeOverride, config);
    ReadNetwork(map, config);
    ReadSecurity(map, "", config, config.Security);
    ReadRadio(map, "", config, config.Radio);
    ReadPaths(map, config);
    ReadRecord(map, config);
    ReadFetch(map, config);
    ReadAgreement(map, config);
    ReadPublish(map, config);
    ReadSubscribe(map, config);
    ReadAccept(map, config);
    ReadSend(map, config);
    ReadForeign(map, config);
    ReadPanels(map, config);
    map.Read("problems_of", config.ProblemsOf);
    map.Read("reports", config.Reports);
    ReadParameters(map, config);
    ValidateGatewayConfig(config, whyNoType);
    return config;
}

}  // namespace

GatewayConfig LoadNetworkConfig(const std::string &file)
{
    const YamlMap map = OpenFile(file);
    GatewayConfig config;
    config.File = file;
    ReadName(map, "any", config);  // any name will do: it is cleared below
    ReadNetwork(map, config);
    ReadSecurity(map, "", config, config.Security);
    ReadRadio(map, "", config, config.Radio);
    ReadPaths(map, config);
    ReadPanels(map, config);
    ValidateGatewayConfig(config);
    config.Node.clear();
    return config;
}

GatewayConfig LoadGatewayConfig(const std::string &file, const std::string &nodeOverride)
{
    return LoadGatewayConfig(file, nodeOverride, WhyNotLinked);
}

GatewayConfig LoadGatewayConfig(const std::string &file, const std::string &nodeOverride,
                                const TypeCheck &whyNoType)
{
    return ConfigOf(OpenFile(file), file, nodeOverride, whyNoType);
}

GatewayConfig ParseGatewayConfig(const std::string &text, const std::string &name,
                                 const std::string &nodeOverride)
{
    return ParseGatewayConfig(text, name, nodeOverride, WhyNotLinked);
}

GatewayConfig ParseGatewayConfig(const std::string &text, const std::string &name,
                                 const std::string &nodeOverride, const TypeCheck &whyNoType)
{
    return ConfigOf(OpenText(name, text), name, nodeOverride, whyNoType);
}

}  // namespace Rabit
