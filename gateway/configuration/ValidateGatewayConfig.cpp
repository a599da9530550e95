#include "configuration/ValidateGatewayConfig.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/NearestWord.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "air/AirSchedule.h"
#include "configuration/ForeignEntries.h"
#include "names/NamePattern.h"
#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

// Prefix of the gateways' own topics.
constexpr const char *OwnTopics = "rabit/";
constexpr double LargestBudget = 1e9;

class Validator
{
public:
    Validator(const GatewayConfig &config, const TypeCheck &whyNoType)
        : _config(config), _whyNoType(whyNoType)
    {
    }

    void Run() const
    {
        CheckNode();
        CheckTool();
        CheckProblemsOf();
        CheckNetwork();
        CheckRadio(_config.Radio, "");
        CheckPaths();
        CheckRecord();
        CheckFetch();
        CheckPublish();
        CheckSubscribe();
        CheckTopicTypes();
        CheckAccept();
        CheckSend();
        CheckForeign(_config, _whyNoType);
        CheckAnnouncement();
    }

private:
    [[noreturn]] void Fail(int line, const std::string &message) const
    {
        throw ConfigError(_config.File, line, message);
    }

    int LineOf(const std::string &key) const
    {
        const auto found = _config.Lines.find(key);
        return found == _config.Lines.end() ? 0 : found->second;
    }

    void CheckNode() const
    {
        if (!IsNodeName(_config.Node))
        {
            Fail(LineOf("node"),
                 _config.Node.empty()
                     ? "no node name; expected `node: <name>`"
                     : "`" + _config.Node + "` is no node name; expected 1 to 64 of A-Z a-z 0-9 _ . -");
        }
        if (!IsNodeName(_config.Name))
        {
            Fail(LineOf("name"),
                 "`" + _config.Name + "` is no name of a gateway; expected 1 to 64 of A-Z a-z 0-9 _ . -");
        }
        if (_config.Name == _config.Node)
        {
            Fail(LineOf(_config.Lines.count("name") > 0 ? "name" : "node"),
                 "node and gateway are both called `" + _config.Node +
                     "`: messages of the two would have the same names");
        }
        if (_config.Domain < 0 || _config.Domain > 232)
        {
            Fail(LineOf("domain"),
                 "domain " + std::to_string(_config.Domain) + " is out of range; expected 0 to 232");
        }
        if (_config.Lease < std::chrono::milliseconds(200) || _config.Lease > std::chrono::hours(1))
        {
            Fail(LineOf("lease"), "the lease is out of range; expected 200ms to 3600s");
        }
    }

    void CheckProblemsOf() const
    {
        if (!_config.ProblemsOf.empty())
        {
            CheckPatterns(_config.ProblemsOf, "problems_of", LineOf("problems_of"));
        }
    }

    void CheckTool() const
    {
        if (!_config.Tool)
        {
            return;
        }
        CheckPatterns(_config.Tool->AsksOf, "Tool.AsksOf", 0);
        if (!_config.Publish.empty() || !_config.Accept.empty())
        {
            Fail(0, "a tool publishes and accepts nothing; expected no `" +
                        std::string(_config.Publish.empty() ? "accept" : "publish") + "`");
        }
    }

    void CheckNetwork() const
    {
        if (_config.MaxDatagram < TransportSettings::SmallestDatagram ||
            _config.MaxDatagram > TransportSettings::LargestDatagram)
        {
            Fail(LineOf("max_datagram"), "max_datagram " + std::to_string(_config.MaxDatagram) +
                                             " is out of range; expected " +
                                             std::to_string(TransportSettings::SmallestDatagram) + " to " +
                                             std::to_string(TransportSettings::LargestDatagram));
        }
        CheckNoneTwice(_config.Interfaces, "interfaces", LineOf("interfaces"));
        CheckNoneTwice(_config.Peers, "peers", LineOf("peers"));
        CheckSecurity(_config.Security, "");
    }

    // `place` is that of a path in the file; empty: the gateway's own settings.
    void CheckSecurity(const std::optional<SecuritySettings> &security, const std::string &place) const
    {
        constexpr int largestDomain = 230;  // the largest that both vendors support with security
        if (security && security->Keys.empty())
        {
            Fail(LineOf(place + "security.keys"), "no folder of keys; expected `keys: <folder>`");
        }
        if (security && _config.Domain > largestDomain)
        {
            Fail(LineOf("domain"), "with security the domain must be 0 to " + std::to_string(largestDomain) +
                                       ", not " + std::to_string(_config.Domain));
        }
    }

    void CheckRadio(const RadioSettings &radio, const std::string &place) const
    {
        if (radio.SlowestBeat < std::chrono::milliseconds(500) || radio.SlowestBeat > std::chrono::minutes(1))
        {
            Fail(LineOf(place + "radio.slowest_beat"),
                 "`slowest_beat` is out of range; expected 500ms to 60s");
        }
        const double least = SmallestBudget(radio.SlowestBeat);
        if (radio.Budget && !(*radio.Budget >= least))
        {
            Fail(LineOf(place + "radio.budget"),
                 "the budget is too small to say that this node is there; expected " +
                     std::to_string(std::lround(least)) + "B/s or more");
        }
        if (radio.Budget && *radio.Budget > LargestBudget)
        {
            Fail(LineOf(place + "radio.budget"),
                 "the budget is out of range; expected 1000MB/s or less, or auto");
        }
    }

    void CheckPaths() const
    {
        if (_config.Paths.empty())
        {
            return;
        }
        for (const char *const key : {"interfaces", "peers", "multicast", "radio"})
        {
            if (LineOf(key) > 0)
            {
                Fail(LineOf(key), std::string("with `paths`, `") + key + "` belongs to a path");
            }
        }
        const std::size_t most = MostPaths;
        if (_config.Paths.size() > most)
        {
            Fail(_config.Paths[most].Line, "too many paths; expected " + std::to_string(most) + " at most");
        }
        std::map<std::string, int> seen;
        for (const PathRule &path : _config.Paths)
        {
            const std::string place = "paths." + path.Name + ".";
            if (!IsNodeName(path.Name))
            {
                Fail(path.Line, "`" + path.Name + "` is no path name; expected 1 to 64 of A-Z a-z 0-9 _ . -");
            }
            CheckOnce(seen, path.Name, "paths", path.Line);
            CheckNoneTwice(path.Interfaces, "interfaces", path.Line);
            CheckNoneTwice(path.Peers, "peers", path.Line);
            CheckRadio(path.Radio, place);
            CheckSecurity(path.Security, place);
        }
        CheckInterfacesOfPaths();
    }

    // Two paths on one network would hear each other, and send all twice.
    void CheckInterfacesOfPaths() const
    {
        std::map<std::string, int> seen;
        for (const PathRule &path : _config.Paths)
        {
            if (path.Interfaces.empty() && _config.Paths.size() > 1)
            {
                Fail(path.Line,
                     "path `" + path.Name +
                         "` needs `interfaces`: without them it uses those of the other paths, too");
            }
            for (const std::string &interface : path.Interfaces)
            {
                CheckOnce(seen, interface, "interfaces", path.Line);
            }
        }
    }

    void CheckRecord() const
    {
        if (!_config.Record)
        {
            return;
        }
        const RecordSettings &record = *_config.Record;
        if (record.Folder.empty())
        {
            Fail(LineOf("record.folder"), "no folder for recordings; expected `folder: <path>`");
        }
        if (record.SplitTime < std::chrono::seconds(1) || record.SplitTime > std::chrono::hours(24))
        {
            Fail(LineOf("record.split_time"), "`split_time` is out of range; expected 1s to 1440min");
        }
        CheckMessagePatterns(record.Messages, "messages", LineOf("record.messages"));
        CheckMessagePatterns(record.Except, "except", LineOf("record.except"));
        CheckMessagePatterns(record.Steps, "steps", LineOf("record.steps"), "name of a manager");
        if (record.BlackBox)
        {
            CheckBlackBox(*record.BlackBox);
        }
        CheckBackfill(record);
    }

    void CheckBackfill(const RecordSettings &record) const
    {
        const int line = LineOf("record.backfill");
        for (const std::string &message : record.Backfill)
        {
            if (std::none_of(_config.Subscribe.begin(), _config.Subscribe.end(),
                             [&message](const SubscribeRule &rule) { return rule.Message == message; }))
            {
                std::vector<std::string> names;
                for (const SubscribeRule &rule : _config.Subscribe)
                {
                    names.push_back(rule.Message);
                }
                Fail(line, "`backfill` names `" + message + "`, which no `subscribe` entry names" +
                               NearestWordHint(message, names));
            }
        }
        CheckNoneTwice(record.Backfill, "backfill", line);
        if (!record.Backfill.empty() && record.BlackBox)
        {
            Fail(line,
                 "`backfill` needs a recording of everything, and `black_box` drops most of it; remove "
                 "one of them");
        }
        if (record.BackfillLast < std::chrono::seconds(1) || record.BackfillLast > std::chrono::hours(24))
        {
            Fail(LineOf("record.backfill_last"), "`backfill_last` is out of range; expected 1s to 1440min");
        }
        if (record.BackfillTo && !record.BackfillTo->empty())
        {
            CheckPatterns(*record.BackfillTo, "backfill_to", LineOf("record.backfill_to"));
        }
    }

    void CheckFetch() const
    {
        if (!_config.Fetch)
        {
            return;
        }
        if (_config.Fetch->Folder.empty())
        {
            Fail(LineOf("fetch.folder"), "no folder of files to fetch; expected `folder: <path>`");
        }
        if (_config.Fetch->From.empty())
        {
            Fail(LineOf("fetch.from"), "nobody may fetch; expected `from: [<node>]`");
        }
        CheckPatterns(_config.Fetch->From, "from", LineOf("fetch.from"));
    }

    void CheckBlackBox(const BlackBoxSettings &box) const
    {
        for (const auto &[key, time] : {std::pair("before", box.Before), std::pair("after", box.After)})
        {
            if (time < std::chrono::seconds(1) || time > std::chrono::hours(1))
            {
                Fail(LineOf(std::string("record.black_box.") + key),
                     std::string("`") + key + "` is out of range; expected 1s to 60min");
            }
        }
        CheckMessagePatterns(box.Messages, "messages", LineOf("record.black_box.messages"));
        CheckMessagePatterns(box.Queues, "queues", LineOf("record.black_box.queues"));
    }

    void CheckMessagePatterns(const std::vector<std::string> &patterns, const char *key, int line,
                              const std::string &what = "message name") const
    {
        for (const std::string &pattern : patterns)
        {
            if (!IsMessageName(WithoutWildcards(pattern)))
            {
                Fail(line, "`" + pattern + "` in `" + key + "` is no " + what +
                               "; `*` and `?` stand for any characters");
            }
        }
        CheckNoneTwice(patterns, key, line);
    }

    void CheckImportance(TrafficClass traffic, double weight, int line) const
    {
        if (traffic == TrafficClass::Presence)
        {
            Fail(line, "the class presence is the gateway's own; expected another one");
        }
        if (!(weight >= AirSchedule::SmallestWeight && weight <= AirSchedule::LargestWeight))
        {
            Fail(line, "`weight` is out of range; expected 0.01 to 100");
        }
    }

    void CheckNoneTwice(const std::vector<std::string> &list, const char *key, int line) const
    {
        std::set<std::string> seen;
        for (const std::string &entry : list)
        {
            if (!seen.insert(entry).second)
            {
                Fail(line, "`" + entry + "` stands twice under `" + key + "`");
            }
        }
    }

    void CheckType(const std::string &type, int line) const
    {
        const std::string why = _whyNoType(type);
        if (!why.empty())
        {
            Fail(line, why);
        }
    }

    void CheckName(const std::string &name, const char *what, int line) const
    {
        if (!IsMessageName(name))
        {
            Fail(line, "`" + name + "` is no " + what + " name; expected 1 to 200 of A-Z a-z 0-9 _ . - : /");
        }
    }

    static std::string FirstIn(int line)
    {
        return line > 0 ? " (first in line " + std::to_string(line) + ")" : "";
    }

    // Remembers a name; fails if it was there before.
    void CheckOnce(std::map<std::string, int> &seen, const std::string &name, const char *list,
                   int line) const
    {
        const auto [place, isNew] = seen.emplace(name, line);
        if (!isNew)
        {
            Fail(line, "`" + name + "` stands twice under `" + list + "`" + FirstIn(place->second));
        }
    }

    void CheckPublish() const
    {
        std::map<std::string, int> seen;
        for (const PublishRule &rule : _config.Publish)
        {
            CheckName(rule.Message, "message", rule.Line);
            if (rule.Message.find('/') != std::string::npos)
            {
                Fail(rule.Line,
                     "`" + rule.Message +
                         "` belongs to another node or to the gateway; expected a name without `/`");
            }
            CheckOnce(seen, rule.Message, "publish", rule.Line);
            CheckType(rule.Type, rule.Line);
            if (!(rule.MaxRate >= 0.0 && rule.MaxRate <= 1e6))
            {
                Fail(rule.Line, "max_rate is out of range; expected 0 (no limit) to 1000000 a second");
            }
            CheckImportance(rule.Class.value_or(TrafficClass::State), rule.Weight, rule.Line);
        }
    }

    void CheckSubscribe() const
    {
        std::map<std::string, int> seen;
        for (const SubscribeRule &rule : _config.Subscribe)
        {
            CheckName(rule.Message, "message", rule.Line);
            CheckOnce(seen, rule.Message, "subscribe", rule.Line);
            CheckType(rule.Type, rule.Line);
            CheckPatterns(rule.From, "from", rule.Line);
            if (rule.Message.rfind(OwnTopics, 0) == 0)
            {
                Fail(rule.Line, "`" + rule.Message + "` is a topic of the gateways themselves");
            }
        }
    }

    // A DDS topic has one type. A local message and the message of that name from other nodes are different
    // messages here, but share one topic.
    void CheckTopicTypes() const
    {
        for (const SubscribeRule &wanted : _config.Subscribe)
        {
            const auto offered =
                std::find_if(_config.Publish.begin(), _config.Publish.end(),
                             [&wanted](const PublishRule &rule) { return rule.Message == wanted.Message; });
            if (offered != _config.Publish.end() && offered->Type != wanted.Type)
            {
                Fail(wanted.Line, "`" + wanted.Message + "` is subscribed as `" + wanted.Type +
                                      "` and published as `" + offered->Type + "`" +
                                      (offered->Line > 0 ? " in line " + std::to_string(offered->Line) : "") +
                                      "; a message has one type");
            }
        }
    }

    void CheckPatterns(const std::vector<std::string> &patterns, const char *key, int line) const
    {
        if (patterns.empty())
        {
            Fail(line, std::string("`") + key + "` is empty; expected node names, `*` and `?` stand for any");
        }
        for (const std::string &pattern : patterns)
        {
            CheckPattern(pattern, key, line);
        }
        CheckNoneTwice(patterns, key, line);
    }

    static std::string WithoutWildcards(std::string pattern)
    {
        std::replace_if(
            pattern.begin(), pattern.end(), [](char c) { return c == '*' || c == '?'; }, 'x');
        return pattern;
    }

    void CheckPattern(const std::string &pattern, const char *key, int line) const
    {
        if (!IsNodeName(WithoutWildcards(pattern)))
        {
            Fail(line,
                 "`" + pattern + "` in `" + key + "` is no node name; `*` and `?` stand for any characters");
        }
    }

    void CheckAccept() const
    {
        std::map<std::string, int> seen;
        for (const AcceptRule &rule : _config.Accept)
        {
            CheckName(rule.Queue, "queue", rule.Line);
            CheckOnce(seen, rule.Queue, "accept", rule.Line);
            if (rule.Types.empty())
            {
                Fail(rule.Line, "queue `" + rule.Queue + "` accepts no types; expected a list of IDL types");
            }
            std::map<std::string, int> types;
            for (const std::string &type : rule.Types)
            {
                CheckType(type, rule.Line);
                CheckOnce(types, type, "types", rule.Line);
            }
            CheckPatterns(rule.From, "from", rule.Line);
        }
    }

    void CheckSend() const
    {
        std::map<std::string, int> seen;
        for (const SendRule &rule : _config.Send)
        {
            CheckPattern(rule.To, "to", rule.Line);
            if (!IsMessageName(WithoutWildcards(rule.Queue)))
            {
                CheckName(rule.Queue, "queue", rule.Line);
            }
            CheckOnce(seen, rule.To + "/" + rule.Queue, "send", rule.Line);
            CheckReached(rule);
            CheckRange(rule.Capacity, 1'000'000, "capacity", rule.Line);
            CheckRange(rule.CapacityBytes, std::size_t{1} << 40, "capacity_bytes", rule.Line);
            CheckRange(rule.Window, 256, "window", rule.Line);
            CheckImportance(rule.Class, rule.Weight, rule.Line);
            if (rule.Expire < std::chrono::milliseconds(0) || rule.Expire > std::chrono::hours(24 * 365))
            {
                Fail(rule.Line, "`expire` is out of range; expected 0 (never) to a year");
            }
        }
    }

    // Fails if the announcement is too large: other nodes would ignore it, and no log would say why.
    void CheckAnnouncement() const
    {
        const std::string excess = Announcements::WhyTooLarge(Announcements::Of(_config));
        if (!excess.empty())
        {
            Fail(0, excess);
        }
    }

    // Fails if an earlier rule fits all links of this one: the first rule that fits a link holds, so this
    // one would do nothing.
    void CheckReached(const SendRule &rule) const
    {
        for (const SendRule &before : _config.Send)
        {
            if (&before == &rule)
            {
                return;
            }
            if (CoversPattern(before.To, rule.To) && CoversPattern(before.Queue, rule.Queue))
            {
                Fail(rule.Line, "this `send` entry is never used: `" + before.To + "/" + before.Queue + "`" +
                                    (before.Line > 0 ? " in line " + std::to_string(before.Line) : "") +
                                    " fits all that `" + rule.To + "/" + rule.Queue +
                                    "` fits, and the first that fits holds");
            }
        }
    }

    void CheckRange(std::size_t value, std::size_t most, const char *key, int line) const
    {
        if (value < 1 || value > most)
        {
            Fail(line, std::string("`") + key + "` is out of range; expected 1 to " + std::to_string(most));
        }
    }

    const GatewayConfig &_config;
    const TypeCheck &_whyNoType;
};

}  // namespace

// A quarter of the budget is reserved for presence: it must hold the beats. DDS's own participant
// announcements are added, and the sum is rounded up to 100 bytes a second.
double SmallestBudget(std::chrono::milliseconds slowestBeat)
{
    constexpr double beat = 160.0;      // bytes on the air, with some versions of States in it
    constexpr double discovery = 20.0;  // bytes a second
    const double seconds = std::chrono::duration<double>(slowestBeat).count();
    return 100.0 * std::ceil((4.0 * beat / seconds + discovery) / 100.0);
}

std::string WhyNotLinked(const std::string &type)
{
    return MessageTypeRegistry::Find(type) != nullptr
               ? ""
               : "unknown IDL type `" + type + "`" + NearestWordHint(type, MessageTypeRegistry::Names());
}

void ValidateGatewayConfig(const GatewayConfig &config, const TypeCheck &whyNoType)
{
    Validator(config, whyNoType).Run();
}

void ValidateGatewayConfig(const GatewayConfig &config)
{
    ValidateGatewayConfig(config, WhyNotLinked);
}

void ValidateTransportName(const GatewayConfig &config, const std::vector<std::string> &available,
                           const std::vector<std::string> &known)
{
    const auto isIn = [](const std::vector<std::string> &names, const std::string &name)
    { return std::find(names.begin(), names.end(), name) != names.end(); };
    for (const GatewayConfig &path : PathConfigsOf(config))
    {
        const std::string &name = path.Transport;
        if (isIn(available, name))
        {
            continue;
        }
        const auto line = path.Lines.find("transport");
        throw ConfigError(
            config.File, line == path.Lines.end() ? 0 : line->second,
            (isIn(known, name) ? "this build is without the transport `" : "unknown transport `") + name +
                "`" + NearestWordHint(name, available));
    }
}

}  // namespace Rabit
