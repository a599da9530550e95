#include "configuration/ValidateGatewayConfig.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/NearestWord.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "configuration/ConfigCheck.h"
#include "configuration/ForeignEntries.h"
#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

constexpr double LargestBudget = 1e9;
// Between the beats of a path without a budget. With one, `slowest_beat` is not less.
constexpr std::chrono::milliseconds UsualBeat{500};

class Validator : ConfigCheck
{
public:
    using ConfigCheck::ConfigCheck;

    void Run() const
    {
        CheckNode();
        CheckTool();
        CheckProblemsOf();
        CheckNetwork();
        CheckRadio(_config.Radio, "");
        CheckPaths();
        CheckLostAfter();
        CheckAgreement();
        CheckRecording(_config, _whyNoType);
        CheckMessages(_config, _whyNoType);
        CheckForeign(_config, _whyNoType);
        CheckAnnouncement();
    }

private:
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
        if (security && security->Keys.empty() && !security->Member)
        {
            Fail(LineOf(place + "security.keys"), "no folder of keys; expected `keys: <folder>`");
        }
    }

    void CheckRadio(const RadioSettings &radio, const std::string &place) const
    {
        if (radio.SlowestBeat < UsualBeat || radio.SlowestBeat > std::chrono::minutes(1))
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

    // The times between the slowest beats of the paths: the shortest, and the longest.
    std::pair<std::chrono::milliseconds, std::chrono::milliseconds> SlowestBeats() const
    {
        std::vector<std::chrono::milliseconds> beats;
        for (const GatewayConfig &path : PathConfigsOf(_config))
        {
            beats.push_back(path.Radio.Budget ? path.Radio.SlowestBeat : UsualBeat);
        }
        const auto [least, most] = std::ranges::minmax(beats);
        return {least, most};
    }

    // On the path with the most frequent beats, a node must be able to beat three times within that time.
    void CheckLostAfter() const
    {
        constexpr int beatsOfStale = 3;
        const std::chrono::milliseconds beat = SlowestBeats().first;
        if (_config.LostAfter &&
            (*_config.LostAfter < beatsOfStale * beat || *_config.LostAfter > std::chrono::hours(1)))
        {
            Fail(LineOf("lost_after"),
                 "`lost_after` is out of range; expected " + std::to_string((beatsOfStale * beat).count()) +
                     "ms to 3600s, as a node may beat each " + std::to_string(beat.count()) + " ms");
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

    void CheckAgreement() const
    {
        if (!_config.Agreement)
        {
            return;
        }
        const std::vector<std::string> &members = _config.Agreement->Members;
        const int line = _config.Agreement->Line;
        const int listLine = std::max(LineOf("agreement.members"), line);
        if (_config.Tool)
        {
            Fail(line, "a tool agrees on nothing; expected no `agreement`");
        }
        if (members.empty() || members.size() > MostAgreementMembers)
        {
            Fail(listLine, "`members` has " + std::to_string(members.size()) + " nodes; expected 1 to " +
                               std::to_string(MostAgreementMembers));
        }
        for (const std::string &member : members)
        {
            if (!IsNodeName(member))
            {
                Fail(listLine,
                     "`" + member + "` in `members` is no node name; expected 1 to 64 of A-Z a-z 0-9 _ . -");
            }
        }
        CheckNoneTwice(members, "members", listLine);
        if (std::find(members.begin(), members.end(), _config.Node) == members.end())
        {
            Fail(listLine, "this node, `" + _config.Node + "`, is not in `members`" +
                               NearestWordHint(_config.Node, members));
        }
        CheckLeaseOfAgreement();
    }

    void CheckLeaseOfAgreement() const
    {
        constexpr std::chrono::milliseconds longest = std::chrono::minutes(1);
        const std::chrono::milliseconds least = 4 * SlowestBeats().second;
        if (_config.Agreement->Lease < least || _config.Agreement->Lease > longest)
        {
            Fail(std::max(LineOf("agreement.lease"), _config.Agreement->Line),
                 "`lease` is out of range; expected " + std::to_string(least.count()) +
                     "ms (four of the slowest beats) to 60s, the same at all members");
        }
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

    // Fails if the announcement is too large: other nodes would ignore it, and no log would say why.
    void CheckAnnouncement() const
    {
        const std::string excess = Announcements::WhyTooLarge(Announcements::Of(_config));
        if (!excess.empty())
        {
            Fail(0, excess);
        }
    }
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
