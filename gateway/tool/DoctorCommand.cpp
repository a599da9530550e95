// rabit doctor: problems of this machine, the network and the fleet, and remedies.
#include <rabit/RabitLog.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <string>

#include "Command.h"
#include "FleetSession.h"
#include "RosNodes.h"
#include "SafeText.h"
#include "Table.h"
#include "doctor/MachineChecks.h"
#include "doctor/NetworkChecks.h"
#include "doctor/NetworkTrial.h"
#include "doctor/NodeChecks.h"
#include "doctor/RtpsCall.h"

namespace Rabit::Tool
{
namespace DoctorParts
{
namespace
{

using Doctor::Finding;
using Doctor::Level;

// Number of domains, from 0, in which participants are asked to announce themselves, besides the configured
// one. Each question takes some 190 bytes on the air.
constexpr int CommonDomains = 10;

// Seconds in which participants without a budget announce themselves again: the announcement period is 10 s.
constexpr double AllAnnounced = 12.0;

std::vector<int> AllDomains()
{
    std::vector<int> domains(Doctor::LastDomain + 1);
    std::iota(domains.begin(), domains.end(), 0);
    return domains;
}

void Append(std::vector<Finding> &all, std::vector<Finding> more)
{
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

const char *WordOf(Level level)
{
    return level == Level::Problem ? "problem" : level == Level::Note ? "note" : "good";
}

bool Show(const Finding &finding, bool json)
{
    if (json)
    {
        return Output::Object(Json{{"level", WordOf(finding.How)},
                                   {"subject", finding.Subject},
                                   {"text", finding.Text},
                                   {"advice", finding.Advice}});
    }
    const char *mark = finding.How == Level::Problem ? "! " : finding.How == Level::Note ? "- " : "  ";
    return Output::Line(SafeText(mark + finding.Subject + ": " + finding.Text +
                                 (finding.Advice.empty() ? "" : ". Do: " + finding.Advice)));
}

int Examine(const CommonOptions &options, Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options);
    config.ProblemsOf = {"*"};
    RosNodes ros;
    RosNodes::AddTo(config);
    const Doctor::MachineFacts before = Doctor::LookAtMachine();
    const std::vector<Doctor::Interface> used = Doctor::UsedBy(config, before.Interfaces);
    std::vector<int> domains{config.Domain};
    for (int domain = 0; domain < CommonDomains; ++domain)
    {
        if (domain != config.Domain)
        {
            domains.push_back(domain);
        }
    }
    std::vector<Finding> findings = Doctor::OfInterfaces(config, before.Interfaces);
    Append(findings, Doctor::OfMtu(config, used));
    bool anyNode = false;
    int code = Good;
    try
    {
        // NetworkTrial listens before DDS does, so that no answer is missed.
        const Doctor::NetworkTrial trial(used, Doctor::UnusedBy(config, before.Interfaces), config.Node,
                                         domains, AllDomains(), Doctor::OwnSealedSessions(config));
        FleetSession session(config, options, wakeup,
                             [&ros](FleetSession &joining) { ros.Attach(joining.Workspace()); });
        double listened = options.Wait;
        session.WaitUntil(listened);
        if (!session.IsAnybodyThere() && !options.IsWaitGiven)
        {
            // The reason may be a domain that is only listened to.
            listened = AllAnnounced;
            session.WaitUntil(listened);
        }
        if (wakeup.IsInterrupted())
        {
            Output::Talk("interrupted after " + NumberText(session.Seconds(), 0) + " of " +
                         NumberText(listened, 0, " s: nothing is known"));
            return Interrupted;
        }
        const std::vector<FleetSession::Node> nodes = session.Nodes();
        const Gateway::Fleet fleet = session.Fleet();
        Doctor::NetworkFacts network = trial.Facts();
        Doctor::NameRosPrograms(ros.Of(fleet), network);
        anyNode = session.IsAnybodyThere();
        Append(findings, Doctor::OfBuffers(config, before, Doctor::LookAtMachine()));
        Append(findings, Doctor::OfMulticast(config, used, network, Doctor::NodesThatHear(fleet)));
        Append(findings, Doctor::OfOtherInterfaces(config, used, network, anyNode));
        Append(findings, Doctor::OfLoopback(config, used, network));
        // If a name is given, this program first listens under the usual one.
        CommonOptions unnamed = options;
        unnamed.Node.Node.clear();
        std::set<std::string> names{ConfigOf(unnamed).Node};
        for (const FleetSession::Node &node : nodes)
        {
            names.insert(node.Name);
        }
        Append(findings, Doctor::OfOtherParticipants(config, network, names));
        Append(findings, Doctor::OfDomains(config, network, anyNode));
        Append(findings, Doctor::OfSilentDomains(config, network, anyNode, CommonDomains, listened));
        Append(findings, Doctor::OfKeys(config, used, network, anyNode));
        Append(findings, Doctor::OfNodes(nodes, fleet));
        Append(findings, Doctor::OfPaths(fleet, session.Seconds()));
        Append(findings, Doctor::OfTypes(nodes));
        Append(findings, Doctor::OfClocks(nodes, fleet));
        Append(findings, Doctor::OfLinks(nodes, fleet));
        Append(findings, Doctor::OfLosses(nodes));
    }
    catch (const NetworkError &error)
    {
        findings.push_back({Level::Problem, "network", error.what(), "docs/how_to/connect.md"});
        code = NoNetwork;
    }
    const auto rank = [](const Finding &finding) { return static_cast<int>(finding.How); };
    std::stable_sort(findings.begin(), findings.end(),
                     [&rank](const Finding &one, const Finding &other) { return rank(one) > rank(other); });
    for (const Finding &finding : findings)
    {
        if (!Show(finding, options.Json))
        {
            return Good;
        }
    }
    if (code == Good && !anyNode)
    {
        Output::Talk("nobody was heard in domain " + std::to_string(config.Domain) + " over " +
                     config.Transport);
        return NoNetwork;
    }
    const bool isGood = std::none_of(findings.begin(), findings.end(),
                                     [](const Finding &finding) { return finding.How == Level::Problem; });
    return code != Good ? code : isGood ? Good : ProblemFound;
}

}  // namespace
}  // namespace DoctorParts

void AddDoctorCommand(CLI::App &app, Chosen &chosen)
{
    using namespace DoctorParts;
    const auto [command, options] = AddCommand<CommonOptions>(
        app, chosen, "doctor", "What is wrong with this machine, the network and the fleet, and what to do",
        &Examine);
    AddCommonOptions(*command, *options, 6.0);
    AddExamples(*command, {"rabit doctor", "rabit doctor --interface wlan0 --domain 7",
                           "rabit doctor --config uav.yaml --wait 35"});
}

}  // namespace Rabit::Tool
