#include "manager/AgreementDriver.h"

#include <rabit/base/Earliest.h>
#include <rabit/base/Fnv1a.h>
#include <rabit/gateway/ConfigError.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "incarnation/StoredNumber.h"
#include "wire/BeatFormat.h"

namespace Rabit
{
namespace
{

// Datagrams of claims begin with 1 and 2, those of tables with 3 and 4.
constexpr std::uint8_t LastOfClaims = 2;

const std::string AgreementSubject = "claims and shared tables";

// Renewals and answers in beats go by one path alone.
AgreementSettings AgreementSettingsOf(const GatewayConfig &config, std::uint64_t incarnation)
{
    return {.Self = config.Node,
            .Incarnation = incarnation,
            .Members = config.Agreement->Members,
            .Lease = config.Agreement->Lease,
            .RidesInBeats = config.Paths.size() <= 1};
}

// Threads of the program draw from it with the hub's mutex held, so it is the hub's own.
std::function<std::uint64_t()> OwnRandom(const RandomSource &random)
{
    return [engine = std::mt19937_64(random())]() mutable { return engine(); };
}

}  // namespace

AgreementDriver::AgreementDriver(const GatewayConfig &config, const RabitClock &clock,
                                 std::uint64_t incarnation, std::filesystem::path fences,
                                 const RandomSource &random, std::function<void()> wake,
                                 RabitHandlerThread *handlers, Network network)
    : _network(std::move(network)),
      _handlers(handlers),
      _clock(clock),
      _wake(
          [woken = _woken, wake = std::move(wake)]
          {
              woken->store(true);
              wake();
          }),
      _fences(std::move(fences)),
      _settings(AgreementSettingsOf(config, incarnation)),
      _group(Fnv1a(_settings.Group()).Folded()),
      // Without Claims in the program, the node votes and passes the table on.
      _hub(config.Agreed ? config.Agreed : std::make_shared<AgreementHub>()),
      _exchange(OpenedTable(config, random))
{
}

TableCopy &AgreementDriver::OpenedTable(const GatewayConfig &config, const RandomSource &random)
{
    const std::uint64_t stored =
        StoredNumber::Read(_fences, std::numeric_limits<std::uint64_t>::max() / 2, "fence", _fenceError);
    const std::uint64_t fences = std::max(stored, (_settings.Incarnation >> 32) * FencesOfASecond);
    if (!_hub->Open(_settings, fences, _clock, OwnRandom(random), _wake))
    {
        throw ConfigError(config.File, config.Agreement->Line,
                          "another gateway serves the claims of this configuration; expected a "
                          "configuration, and claims, of its own for each gateway");
    }
    return *_hub->WithTable([](TableCopy &table) { return &table; });
}

AgreementDriver::~AgreementDriver()
{
    if (!_hasLeft)
    {
        static_cast<void>(_hub->Close());
    }
}

void AgreementDriver::OnFrame(std::string_view node, std::span<const std::uint8_t> frame)
{
    {
        const std::lock_guard lock(_mutex);
        const std::size_t cost = frame.size() + CostOfEntry;
        const auto share = _inboxShares.find(node);
        const std::size_t former = share == _inboxShares.end() ? 0 : share->second;
        if (frame.size() < 2 || (frame[1] <= LastOfClaims && !_settings.IsMember(node)) ||
            cost > LargestInbox - _inboxBytes || cost > LargestShare - former)
        {
            ++_dropped;
            return;
        }
        _inboxBytes += cost;
        _inboxShares.insert_or_assign(std::string(node), former + cost);
        const auto datagram = frame.subspan(1);
        _inbox.emplace_back(node, std::vector<std::uint8_t>(datagram.begin(), datagram.end()));
    }
    _wake();
}

std::size_t AgreementDriver::NewsSize() const
{
    if (_hasLeft || !_settings.RidesInBeats)
    {
        return BeatFormat::Agreement(0, 0);
    }
    return _hub->With(
        [](const AgreementNode &node, Duration /*now*/)
        {
            return BeatFormat::Agreement(node.Own().Renews() ? AgreementNode::RenewalBytes : 0,
                                         node.AnswersForBeat() * AgreementNode::AnswerBytes);
        });
}

AgreementNews AgreementDriver::News(std::size_t room)
{
    AgreementNews news;
    news.Group = _group;
    if (_hasLeft)
    {
        return news;
    }
    news.Table = _hub->WithTable([](const TableCopy &table) { return table.Digest(); });
    if (_settings.RidesInBeats)
    {
        static_assert(AgreementNode::MostBeatAnswers * AgreementNode::AnswerBytes ==
                      AgreementNews::MostAnswers);
        const bool renews = BeatFormat::Agreement(AgreementNode::RenewalBytes, 0) <= room;
        const std::size_t renewal = renews ? AgreementNode::RenewalBytes : 0;
        std::size_t answers = AgreementNode::MostBeatAnswers;
        while (answers > 0 && BeatFormat::Agreement(renewal, answers * AgreementNode::AnswerBytes) > room)
        {
            --answers;
        }
        AgreementNode::Beat beat = _hub->With([renews, answers](AgreementNode &node, Duration now)
                                              { return node.TakeBeat(now, renews, answers); });
        news.Renewal = std::move(beat.Renewal);
        // The own vote has made the lease longer.
        _woken->store(true);
        news.Answers = std::move(beat.Answers);
    }
    return news;
}

void AgreementDriver::OnBeat(const Presence::Served::Agreement &told)
{
    if (_hasLeft)
    {
        return;
    }
    if (told.News.Group == _group)
    {
        _hub->With(
            [&told](AgreementNode &node, Duration now)
            {
                node.OnBeat(told.Node, told.Incarnation,
                            {.Renewal = told.News.Renewal, .Answers = told.News.Answers}, now);
            });
    }
    _hub->WithTable([&](const TableCopy & /*table*/)
                    { _exchange.OnDigest(told.Node, told.News.Table, _clock.Monotonic()); });
    _woken->store(true);
}

void AgreementDriver::LookAt(const PeersOverPaths &peers)
{
    if (_hasLeft)
    {
        return;
    }
    _exchange.ForgetUnless([this](const std::string &node) { return _network.GroupOf(node).has_value(); });
    std::size_t up = 0;
    std::size_t early = 0;
    for (const PeerTable::Peer *const peer : peers.Heard())
    {
        // Nodes that are silent tell nothing of this node's clock.
        const bool isUp = peer->Agreement && peer->State == Gateway::NodeState::UP;
        up += isUp ? 1U : 0U;
        early += isUp && peer->Clock.StoodStillHere() ? 1U : 0U;
    }
    // One node's beats may come early since a queue on their way has emptied.
    const bool stoodStill = 2 * early > up;
    if (stoodStill && !std::exchange(_stoodStill, true))
    {
        _hub->With([](AgreementNode &node, Duration now) { node.ClockStoodStill(now); });
        _woken->store(true);
    }
    _stoodStill = stoodStill;
    if (peers.OwnNameTwice())
    {
        _hub->With([](AgreementNode &node, Duration now) { node.NameIsTaken(now); });
    }
}

AgreementDriver::Duration AgreementDriver::Serve(Duration now)
{
    if (_hasLeft)
    {
        return Duration::max();
    }
    if (!_woken->exchange(false) && now < _due)
    {
        return _due;
    }
    const RabitHandlerThread::Scope scope(_handlers, AgreementSubject, _hub);
    TakeInbox();
    do
    {
        SendDue();
    } while (StoreFences());
    SendTables();
    Tell(now);
    _due = NextDue(now).value_or(Duration::max());
    return _due;
}

std::optional<AgreementDriver::Duration> AgreementDriver::NextDue(Duration now)
{
    const auto [due, stores] = _hub->With([](const AgreementNode &node, Duration /*now*/)
                                          { return std::pair(node.Due(), node.StoreWanted().has_value()); });
    return Earliest<Duration>({due, stores ? std::optional(_storeAt) : std::nullopt,
                               _exchange.IsWaiting() ? std::optional(now + TablePace) : std::nullopt});
}

void AgreementDriver::TakeInbox()
{
    std::vector<std::pair<std::string, std::vector<std::uint8_t>>> inbox;
    {
        const std::lock_guard lock(_mutex);
        inbox.swap(_inbox);
        _inboxBytes = 0;
        _inboxShares.clear();
    }
    for (const auto &[node, datagram] : inbox)
    {
        if (datagram.front() <= LastOfClaims)
        {
            _hub->With([&from = node, &bytes = datagram](AgreementNode &member, Duration now)
                       { member.OnDatagram(from, bytes, now); });
        }
        else if (_network.GroupOf(node))
        {
            _hub->WithTable([&, &from = node, &bytes = datagram](const TableCopy & /*table*/)
                            { _exchange.OnDatagram(from, bytes, _clock.Monotonic()); });
        }
    }
}

void AgreementDriver::SendDue()
{
    while (const auto datagram =
               _hub->With([](AgreementNode &node, Duration now) { return node.TakeDue(now); }))
    {
        Send(*datagram);
    }
}

void AgreementDriver::Send(const AgreementNode::Datagram &datagram)
{
    for (const std::string &member : _settings.Members)
    {
        const bool isMeant = datagram.To.empty() || datagram.To == member;
        // Others do not hear this node, or take it for a node with another list.
        if (isMeant && _network.GroupOf(member) == _group)
        {
            SendTo(member, datagram.Bytes);
        }
    }
}

void AgreementDriver::SendTables()
{
    std::set<std::size_t> used;
    const auto mayGo = [this, &used](const TableExchange::Datagram &datagram)
    {
        return !used.contains(_network.PathTo(datagram.To)) &&
               _network.HasRoom(datagram.To, datagram.Bytes.size() + 1);
    };
    while (const auto datagram = _exchange.TakeDatagram(mayGo))
    {
        used.insert(_network.PathTo(datagram->To));
        SendTo(datagram->To, datagram->Bytes);
    }
}

bool AgreementDriver::StoreFences()
{
    const std::optional<std::uint64_t> upTo =
        _hub->With([](const AgreementNode &node, Duration /*now*/) { return node.StoreWanted(); });
    if (!upTo || _clock.Monotonic() < _storeAt)
    {
        return false;
    }
    _fenceError = _fences.empty() ? "" : StoredNumber::Write(_fences, *upTo);
    const bool isStored = _fenceError.empty();
    _storeAt = _clock.Monotonic() + (isStored ? Duration(0) : StoreAgainAfter);
    _hub->With([&](AgreementNode &node, Duration now) { node.Stored(*upTo, isStored, now); });
    return true;
}

void AgreementDriver::SendTo(const std::string &node, const std::vector<std::uint8_t> &datagram)
{
    std::vector<std::uint8_t> frame{FirstByte};
    frame.insert(frame.end(), datagram.begin(), datagram.end());
    _network.Send(node, frame);
}

void AgreementDriver::Leave()
{
    const RabitHandlerThread::Scope scope(_handlers, AgreementSubject, _hub);
    _hasLeft = true;
    for (const AgreementNode::Datagram &datagram : _hub->Close())
    {
        Send(datagram);
    }
    _hub->TellClaims();
}

}  // namespace Rabit
