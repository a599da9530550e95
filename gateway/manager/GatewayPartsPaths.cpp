// The networks of a gateway: how they are made, and the choice between them.
#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "manager/GatewayParts.h"
#include "manager/TransportSettingsOf.h"

namespace Rabit
{
namespace
{

constexpr std::chrono::nanoseconds LookPeriod = std::chrono::milliseconds(50);

}  // namespace

void GatewayManager::Parts::MakePaths(const std::vector<std::shared_ptr<Transport>> &transports,
                                      const RandomSource &random)
{
    const GatewayPath::Shared shared{
        .Manager = _manager,
        .WakeUp = _manager.WakeUpHandler(),
        .Workspace = _workspace,
        .Incarnation = _incarnation,
        .Source = _source,
        .Origins = _origins,
        .Remote = _remote,
        .Links = _links,
        .Subscribed = _subscriptions,
        .Foreign = _foreign,
        .Choice = _choice,
        .Members = _members,
        .Random = random,
        .IsNeeded = [this](const std::string &node) { return IsNeeded(node); },
        .OnText = [this](const std::string &node, std::uint64_t definition, TypeQuestions::Answer answer)
        { OnText(node, definition, std::move(answer)); },
        .ReportOf = [this](NodeReports::Name name) { return ReportOf(name); }};
    const std::vector<GatewayConfig> configs = PathConfigsOf(_config);
    _subscriptions.SetSessions(configs.size());
    std::vector<const PeerTable *> tables;
    for (std::size_t path = 0; path < configs.size(); ++path)
    {
        _paths.push_back(std::make_unique<GatewayPath>(configs[path], transports[path], path, shared));
        tables.push_back(&_paths.back()->Beats().Peers());
        if (_agreement)
        {
            _paths.back()->Beats().SetAgreement(
                {.Size = [this] { return _agreement->NewsSize(); },
                 .Take = [this](std::size_t room) { return _agreement->News(room); }});
        }
        // Frames that come late, after the agreement was taken out of the configuration, are no fault.
        _links.AddOtherFrames(
            path, AgreementDriver::FirstByte,
            [agreement = _agreement.get()](std::string_view node, std::span<const std::uint8_t> frame)
            {
                if (agreement != nullptr)
                {
                    agreement->OnFrame(node, frame);
                }
            });
    }
    _peers.emplace(std::move(tables), _choice);
    if (_paths.size() > 1)
    {
        _links.SetSecondPath(
            {.Choose =
                 [this](std::string_view node, std::string_view queue, std::size_t bytes)
             {
                 const std::optional<std::size_t> second = _choice.Second(node, Now(), queue.empty());
                 return second && _paths[*second]->MayTakeCopy(node, queue, bytes) ? second : std::nullopt;
             },
             .Sent = [this](std::size_t path) { _paths[path]->SentPast(); },
             .TakesAnswers = [this](std::string_view node)
             { return _choice.Second(node, Now(), true).has_value(); }});
    }
}

void GatewayManager::Parts::TakeIn(std::size_t path, const PeerTable::Change &heard, Heard &change)
{
    Presence &beats = _paths[path]->Beats();
    for (const std::string &node : heard.Forgotten)
    {
        Forget(node, path);
    }
    if (_paths.size() > 1 && (heard.State || heard.NewLife || heard.Offers))
    {
        for (const PeerTable::Peer *peer : beats.Peers().Heard())
        {
            _choice.Heard(peer->Node, path, peer->State, peer->HearsHereFirst);
            ShareOffers(*peer, beats, change);
        }
    }
    if (_paths.size() > 1)
    {
        for (const std::string &tool : beats.Peers().HeardTools())
        {
            _choice.Heard(tool, path, Gateway::NodeState::UP, false);
        }
    }
    if (heard.NewLife)
    {
        for (const PeerTable::Peer *peer : beats.Peers().Heard())
        {
            _links.HeardOf(peer->Node, peer->Incarnation);
        }
    }
    change.State |= heard.State;
    change.Offers |= heard.Offers;
    change.NewLife |= heard.NewLife;
}

void GatewayManager::Parts::ShareOffers(const PeerTable::Peer &peer, Presence &beats, Heard &change)
{
    for (const auto &path : _paths)
    {
        const PeerTable::Peer *const other = path->Beats().Peers().Find(peer.Node);
        if (other != nullptr && other != &peer)
        {
            const bool isNew = path->Beats().Adopt(peer) || beats.Adopt(*other);
            change.Offers |= isNew;
        }
    }
}

void GatewayManager::Parts::Forget(const std::string &node, std::size_t path)
{
    const bool isKnownElsewhere =
        std::any_of(_paths.begin(), _paths.end(),
                    [&node](const auto &other) { return other->Beats().Peers().Find(node) != nullptr; });
    if (isKnownElsewhere)
    {
        _choice.Heard(node, path, Gateway::NodeState::LOST, false);
        return;
    }
    _choice.Forget(node);
    _subscriptions.Forget(node);
    _links.Forget(node);
    _outgoing->Forget(node);
}

void GatewayManager::Parts::LookAtBeats(Duration now)
{
    _nextLook = now + LookPeriod;
    for (std::size_t path = 0; path < _paths.size(); ++path)
    {
        for (const PeerTable::Peer *peer : _paths[path]->Beats().Peers().Heard())
        {
            _choice.Look(
                peer->Node, path,
                {peer->Incarnation, peer->Beats,
                 std::max(now - peer->LastHeard - peer->Period, peer->Clock.LastDelay()), peer->Period});
        }
    }
}

void GatewayManager::Parts::ChoosePaths(Heard &change, Duration now)
{
    if (now >= _nextLook)
    {
        LookAtBeats(now);
    }
    for (const auto &[node, came] : _links.TakeCameBy())
    {
        for (std::size_t path = 0; path < _paths.size(); ++path)
        {
            if ((came.First >> path & 1) != 0)
            {
                _choice.CameBy(node, path, now);
            }
            if ((came.Messages >> path & 1) != 0)
            {
                _choice.MessageCameBy(node, path, now);
            }
        }
    }
    for (const std::string &node : _links.Unanswered())
    {
        if (_choice.Unanswered(node, now))
        {
            _links.ProbeNow(node);
        }
    }
    for (const std::string &node : _choice.TakeChanged())
    {
        GatewayPath &path = *_paths[_choice.Of(node)];
        path.Beats().Publish(node);
        path.SubscriptionsAdded(now);
        _links.PathChanged(node);
        change.State = change.Offers = true;
    }
    const bool tellsHeard = _choice.TakeFirstHeardChanged() || change.NewLife;
    for (std::size_t path = 1; path < _paths.size() && tellsHeard; ++path)
    {
        _paths[path]->Beats().SetFirstHeard(_choice.FirstHeardOn(path));
    }
}

}  // namespace Rabit
