#include "manager/GatewayPath.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <utility>

#include "manager/TransportSettingsOf.h"
#include "report/FleetReport.h"
#include "report/Loneliness.h"
#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

// A round trip that a radio with a low rate alone may cause.
constexpr GatewayPath::Duration ShortWays = std::chrono::milliseconds(100);

}  // namespace

GatewayPath::GatewayPath(GatewayConfig config, std::shared_ptr<Rabit::Transport> transport,
                         std::size_t number, const Shared &shared)
    : _config(std::move(config)),
      _transport(std::move(transport)),
      _number(number),
      _shared(shared),
      _presence(_config.Node, shared.Incarnation, shared.Workspace.GetClock(), shared.Source, shared.Origins,
                shared.Remote, shared.Random, shared.IsNeeded, shared.WakeUp,
                [this](const std::string &node) { return Carries(node); }),
      _states(_presence, shared.Subscribed, shared.Random),
      _types(_config, _presence, shared.Links, number, shared.WakeUp, shared.OnText, shared.ReportOf),
      _air(_config, shared.Workspace.GetClock(), _presence, shared.Links, _publishers,
           number == 0 ? &shared.Foreign.Publishers() : nullptr, _types, shared.Choice, number)
{
}

void GatewayPath::Join()
{
    TransportSettings settings = TransportSettingsOf(_config, _shared.Incarnation);
    AddSecurity(_config, settings, _shared.Members);
    _session = _transport->Open(settings, [this](const PeerEvent &event) { _presence.OnPeer(event); });
    _air.TakeTurns(*_session, _shared.WakeUp);
}

void GatewayPath::Open()
{
    _openedAt = _shared.Workspace.GetClock().Monotonic();
    if (_config.Tool)
    {
        _presence.BeTool([this](const std::string &node) { return MatchesAny(_config.Tool->AsksOf, node); });
    }
    if (_config.LostAfter)
    {
        _presence.SetLostAfter(*_config.LostAfter);
    }
    if (_config.Replay)
    {
        _presence.BeReplay();
    }
    // First, so that the others learn of this node as early as possible.
    _presence.Open(*_session, Announcements::Of(_config));
    _shared.Links.Open(*_session);
    _shared.Subscribed.Open(*_session);
    for (const PublishRule &rule : _config.Publish)
    {
        _publishers.emplace_back(rule, *MessageTypeRegistry::Find(rule.Type), _config.Node, _shared.Source,
                                 *_session);
        Attach(_publishers.back());
    }
}

void GatewayPath::Begin()
{
    _air.Open(*_session);
    _states.Open(_publishers);
}

void GatewayPath::Close()
{
    _air.Close();
    _publishers.clear();
    _session.reset();
}

void GatewayPath::Attach(TopicPublisher &publisher)
{
    if (_shared.Manager.AddPublishSubscribeMessage(publisher.Rule().Message, publisher.Local()))
    {
        _shared.Manager.WakeUpManagerOnMessagePost(publisher.Local());
        publisher.SetAttached();
    }
}

void GatewayPath::TakeDelays(const Presence::Served &served, Duration now)
{
    for (const Presence::DelayHeard &delay : served.Delays)
    {
        // On a long path datagrams are sent while a report is under way. It is not about these, so its way is
        // subtracted.
        const Duration ways = Carries(delay.Node) ? _shared.Links.ShortestRoundTrip(delay.Node) : Duration(0);
        const Duration known = std::max(ways - ShortWays, Duration(0));
        _air.Reported(delay.Peer, delay.Delay, delay.ArrivedAt - known, now);
    }
    for (const auto &[peer, sentAt] : served.NothingLate)
    {
        _air.NothingLate(peer, sentAt, now);
    }
    if (_shared.Links.HasDelays())
    {
        _shared.Links.TakeDelays(_number, now,
                                 [this](const std::string &node, Duration delay, Duration arrivedAt)
                                 { _presence.NoteDelay(node, delay, arrivedAt); });
    }
}

void GatewayPath::AddProblems(Gateway::Fleet &fleet, Duration now) const
{
    const auto hearsPrograms = [this] { return Loneliness::HearsPrograms(*_session); };
    if (auto lonely =
            Loneliness::Look(_config, _presence.Peers(), _session->Counters(), hearsPrograms, _openedAt, now))
    {
        lonely->subject = Name().empty() ? lonely->subject : "path " + Name();
        fleet.problems.push_back(std::move(*lonely));
    }
    FleetReport::AddNetworkProblems(_session->NetworkProblems(), fleet);
    const std::vector<Gateway::Problem> ofBeats = _presence.Problems(now);
    fleet.problems.insert(fleet.problems.end(), ofBeats.begin(), ofBeats.end());
}

}  // namespace Rabit
