// The reports of a gateway: Gateway/Fleet, its problems and its log, and answers to nodes that request
// reports.
#include <rabit/RabitLog.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <utility>

#include "manager/GatewayParts.h"
#include "report/Diagnosis.h"
#include "report/FleetReport.h"
#include "report/ManagerTroubles.h"
#include "report/OtherGateways.h"
#include "report/PathReport.h"
#include "wire/AgreementReport.h"
#include "wire/ForeignReport.h"

namespace Rabit
{

void GatewayManager::Parts::ReportUndelivered() const
{
    // A program that ends soon after a refusal learns the reason nevertheless. Other problems may only be
    // the end of the other managers.
    Log(_problemLog.AtEnd(_outgoing->Problems()));
    for (const Gateway::LinkStatus &link : _outgoing->Status())
    {
        if (link.outbox > 0)
        {
            RabitLog::Write(RabitLogLevel::Warning,
                            _logName + std::to_string(link.outbox) + " messages for `" + link.node + "/" +
                                link.queue + "` were accepted and not acknowledged before the end");
        }
    }
}

void GatewayManager::Parts::Log(const std::vector<std::string> &lines) const
{
    for (const std::string &line : lines)
    {
        RabitLog::Write(RabitLogLevel::Warning, _logName + line);
    }
}

void GatewayManager::Parts::TellClocks() const
{
    std::vector<GatewayTap::PeerClock> peers;
    for (const PeerTable::Peer *peer : _peers->Heard())
    {
        if (const auto relation = peer->Clock.Source())
        {
            peers.push_back({peer->Node, peer->Incarnation, relation->ToLocal, peer->Clock.RoundTrip()});
        }
    }
    _config.Tap->Clocks(_incarnation, Duration(_source.At(Duration(0))), peers);
}

void GatewayManager::Parts::PostFleet(Duration now)
{
    Gateway::Fleet &fleet = *_fleet;
    fleet.Clear();
    fleet.node = _config.Node;
    fleet.incarnation = _incarnation;
    _subscriptions.Report(fleet);
    ReportPublications(fleet);
    fleet.links = _outgoing->Status();
    fleet.inbound = _links.InboundStatus();
    fleet.forgotten = _peers->Forgotten();
    fleet.crowded_out = _peers->CrowdedOut() + _subscriptions.CrowdedOut() + _links.CrowdedOut();
    fleet.malformed = _links.Malformed();
    FleetReport::FillNodes(*_peers, now, fleet);
    _problemTexts.Fill(*_peers, fleet);
    for (const auto &path : _paths)
    {
        fleet.malformed += path->Beats().Malformed() + path->Types().Malformed();
    }
    fleet.malformed += _agreement ? _agreement->Malformed() : 0;
    ReportAir(fleet, now);
    FleetReport::AddNameProblems(*_peers, fleet);
    AddProblems(now, fleet);
    for (Gateway::Problem &problem : _fullQueues.Look(_workspace.GetListOfQueues(), fleet, *_peers, now))
    {
        fleet.problems.push_back(std::move(problem));
    }
    _foreign.Report(now, fleet);
    OtherGateways::AddSharedNodes(_workspace, _config.Name, fleet);
    const std::vector<LinkStrain> strains = _strains.Look(fleet, *_peers, now);
    for (const auto &path : _paths)
    {
        path->Beats().SetStrains(strains);
    }
    {
        const auto global = fleet.GetGlobalPublishSubscribeMessageRef();
        const RabitHandlerThread::Scope scope(Handlers(), _fleetName, global);
        fleet.PostMessage();
    }
    Log(_problemLog.Look(fleet.problems, now));
    _lasted = _problemLog.Lasted(now);
    constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
    const auto count = static_cast<std::uint16_t>(std::min(_lasted.Problems.size(), most));
    // No node lists a tool, so a tool does not tell its problems.
    for (const auto &path : _paths)
    {
        path->Beats().SetProblems(_config.Tool ? ProblemCount() : ProblemCount{count, _lasted.Digest});
    }
    for (const PeerTable::Peer *peer : _peers->Heard())
    {
        const TypeQuestions::Wanted problems{peer->Node, "",
                                             NodeReports::NameOf(NodeReports::Kind::Problems)};
        if (!_problemTexts.Lacks(*peer))
        {
            PathOf(peer->Node).Beats().TypesLacking().LetGo(problems);
        }
        else if (MatchesAny(_config.ProblemsOf, peer->Node))
        {
            // If too many texts are wanted, the next post asks again.
            static_cast<void>(PathOf(peer->Node).Types().Want(problems, now));
        }
    }
}

void GatewayManager::Parts::ReportPublications(Gateway::Fleet &fleet) const
{
    for (const TopicPublisher &publisher : _paths.front()->Publishers())
    {
        fleet.publications.push_back(publisher.Status());
    }
    for (std::size_t path = 1; path < _paths.size(); ++path)
    {
        for (std::size_t i = 0; i < fleet.publications.size(); ++i)
        {
            PathReport::Add(_paths[path]->Publishers()[i].Status(), fleet.publications[i]);
        }
    }
}

void GatewayManager::Parts::ReportAir(Gateway::Fleet &fleet, Duration now)
{
    if (_paths.size() == 1)
    {
        fleet.air = _paths.front()->Report(fleet, now);
        return;
    }
    std::vector<std::string> names;
    for (const auto &path : _paths)
    {
        names.push_back(path->Name());
        Gateway::PathStatus &status = fleet.paths.emplace_back();
        status.path = path->Name();
        status.air = path->Report(fleet, now);
        PathReport::Add(status.air, fleet.air);
    }
    PathReport::FillNodes(*_peers, _choice, names, now, fleet);
}

std::optional<std::string> GatewayManager::Parts::ReportOf(NodeReports::Name name) const
{
    switch (name.What)
    {
        case NodeReports::Kind::Problems:
            // If words are refused, the digest alone: with it the requests end.
            return ProblemTexts::ReportOf(
                _config.Reports ? _lasted : ProblemLog::Standing{.Problems = {}, .Digest = _lasted.Digest});
        case NodeReports::Kind::Air:
            return AirReport::TextOf(_fleet->air);
        case NodeReports::Kind::LastLines:
            return _config.Reports ? std::optional(_log.Last(name.Argument)) : std::nullopt;
        case NodeReports::Kind::LinesFrom:
            return _config.Reports ? _log.From(name.Argument) : std::nullopt;
        case NodeReports::Kind::Foreign:
            return _config.Reports ? std::optional(ForeignReport::TextOf(_fleet->foreign)) : std::nullopt;
        case NodeReports::Kind::Agreement:
            if (!_config.Reports)
            {
                return std::nullopt;
            }
            return _claims ? AgreementReport::TextOf(AgreementReport::Of(*_config.Agreement, *_claims)) : "";
        case NodeReports::Kind::Echo:
            break;
    }
    return std::string();
}

void GatewayManager::Parts::OnText(const std::string &node, std::uint64_t definition,
                                   TypeQuestions::Answer answer)
{
    const auto report = NodeReports::NameIn(definition);
    if (!report)
    {
        _exploration.AddText(definition, std::move(answer.Text));
    }
    else if (report->What == NodeReports::Kind::Problems)
    {
        if (const PeerTable::Peer *peer = _peers->Find(node))
        {
            _problemTexts.Add(*peer, answer.Text);
            _nextFleet = std::min(_nextFleet, _earliestFleet);
        }
    }
    else
    {
        _exploration.AddReport(node, *report, {std::move(answer.Text), Now() - answer.AskedAt});
    }
}

void GatewayManager::Parts::AddProblems(Duration now, Gateway::Fleet &fleet) const
{
    for (const auto &path : _paths)
    {
        path->AddProblems(fleet, now);
    }
    FleetReport::AddNetworkProblems(_members.Problems(std::time(nullptr)), fleet);
    for (std::size_t i = 0; i < _paths.front()->Publishers().size(); ++i)
    {
        const TopicPublisher &publisher = _paths.front()->Publishers()[i];
        const bool isUnwritable =
            std::any_of(_paths.begin(), _paths.end(),
                        [i](const auto &path) { return path->Publishers()[i].IsUnwritable(); });
        if (isUnwritable)
        {
            fleet.problems.push_back({"publish " + publisher.Rule().Message, "",
                                      "the last post of `" + publisher.Rule().Message +
                                          "` cannot be written: it does not fit `" + publisher.Rule().Type +
                                          "` or is too large; other nodes keep the one before"});
        }
        if (!publisher.IsAttached())
        {
            fleet.problems.push_back({"publish " + publisher.Rule().Message, "",
                                      "the local message `" + publisher.Rule().Message +
                                          "` is of another type than `" + publisher.Rule().Type + "`"});
        }
    }
    for (const auto &problems :
         {_config.Tap ? _config.Tap->Problems() : std::vector<Gateway::Problem>(),
          Diagnosis::OfSubscriptions(_subscriptions, *_peers, now - _openedAt, now),
          Diagnosis::OfLostNodes(_subscriptions.Rules(), _config.Send, fleet, *_peers),
          _agreement ? _agreement->Problems(*_peers, now) : std::vector<Gateway::Problem>(),
          _outgoing->Problems(), _links.Problems(), _slow.Problems(now),
          ManagerTroubles::ProblemsOf(_workspace.GetListOfTroubledManagers())})
    {
        fleet.problems.insert(fleet.problems.end(), problems.begin(), problems.end());
    }
}

}  // namespace Rabit
