#include "manager/AirTraffic.h"

#include <algorithm>
#include <utility>

#include "manager/ImportanceOf.h"
#include "manager/TransportSettingsOf.h"
#include "report/FleetReport.h"
#include "wire/BeatFormat.h"

namespace Rabit
{
namespace
{

using Duration = AirTraffic::Duration;

// Periods in which the sent bytes and the capacity estimate are read. Bytes sent within a period count as
// sent at its end.
constexpr Duration WatchPeriod = std::chrono::milliseconds(10);
constexpr Duration LimitPeriod = std::chrono::milliseconds(100);
// While links wait for their turn, period of checks for other work of theirs, such as a message that expires.
constexpr Duration LookPeriod = std::chrono::milliseconds(20);

// Each copy of a beat has room for a body of this size, however many copies there are: 200 bytes on the air.
constexpr std::size_t SmallBeat = BeatFormat::WithNews + 72;

// A beat may ride by this part of its period before it is promised.
constexpr int EarlyPart = 5;

// Share of a budget that copies of States and telemetry leave free, but for one datagram: half of a small
// budget with it.
constexpr double KeptShare = 0.6;

std::size_t LargestDatagramOf(const GatewayConfig &config)
{
    return config.MaxDatagram + AirCost::IpAndUdp;
}

}  // namespace

AirTraffic::AirTraffic(const GatewayConfig &config, const RabitClock &clock, Presence &presence,
                       LinkDriver &links, std::deque<TopicPublisher> &publishers,
                       std::deque<ForeignPublisher> *foreign, TypeExchange &types, const PathChoice &choice,
                       std::size_t path)
    : _config(config),
      _clock(clock),
      _presence(presence),
      _links(links),
      _publishers(publishers),
      _types(types),
      _choice(choice),
      _path(path),
      _cost(config.MaxDatagram),
      _schedule(LargestDatagramOf(config)),
      _unscheduled(TransportSettingsOf(config, 0).AnnouncementPeriod),
      _beat(_schedule.AddStream(TrafficClass::Presence, AirSchedule::LargestWeight)),
      _typeTexts(_schedule.AddStream(TrafficClass::Bulk)),
      _cards(_schedule.AddStream(TrafficClass::State, AirSchedule::LargestWeight)),
      _linkStreams(
          config.Send, links, _schedule,
          [&presence](std::string_view node) { return presence.SessionsOf(node); }, choice, path),
      _foreign(foreign, _schedule),
      _report(config, _cost)
{
}

void AirTraffic::TakeTurns(TransportSession &session, std::function<void()> wakeUp)
{
    _turns = session.Discovery();
    if (_turns != nullptr)
    {
        _turns->Schedule(std::move(wakeUp));
    }
}

void AirTraffic::Open(TransportSession &session)
{
    _session = &session;
    for (const TopicPublisher &publisher : _publishers)
    {
        _publisherStreams.push_back(
            _schedule.AddStream(ImportanceOf(publisher.Rule()), publisher.Rule().Weight));
    }
    _foreign.Open();
    // Bytes that were sent while the session was opened count as sent now.
    _watchedAt = Now();
    SetLimit(_watchedAt);
}

Duration AirTraffic::Serve(Duration now)
{
    if (now - _watchedAt >= WatchPeriod || IsScheduled())
    {
        Watch(now);
    }
    if (now - _limitSetAt >= LimitPeriod)
    {
        SetLimit(now);
    }
    return IsScheduled() ? ServeLimited() : ServeUnlimited(now);
}

void AirTraffic::Reported(CapacityEstimate::Peer peer, Duration delay, Duration arrivedAt, Duration now)
{
    Watch(now);
    _estimate.Reported(peer, delay, arrivedAt, now);
    SetLimit(now);
}

bool AirTraffic::MayTakeCopy(std::string_view node, std::string_view queue, std::size_t bytes)
{
    const Duration now = Now();
    Watch(now);  // the bytes before it
    return (queue.empty() || ImportanceOf(_config.Send, node, queue).Class != TrafficClass::Bulk) &&
           _schedule.MaySend(bytes, now);
}

void AirTraffic::SentPast()
{
    const Duration now = Now();
    const std::size_t bytes = TakeSent();
    _estimate.Sent(bytes, now);
    _schedule.SentPast(bytes, now);
}

std::size_t AirTraffic::TakeSent()
{
    const TransportCounters counters = _session->Counters();
    LookAtDiscovery(counters.DiscoveryBytes);
    _beats.SampleBytesSent(counters.SampleBytes - std::min(counters.SampleBytes, _samples));
    _samples = counters.SampleBytes;
    const std::uint64_t sent = counters.DiscoveryBytes + counters.SampleBytes;
    const std::uint64_t before = std::exchange(_sent, sent);
    return static_cast<std::size_t>(sent - std::min(sent, before));
}

void AirTraffic::LookAtDiscovery(std::uint64_t sent)
{
    const std::uint64_t before = std::exchange(_discovered, sent);
    if (_discovery.IsOverAfter(static_cast<std::size_t>(sent - std::min(sent, before)), Now()))
    {
        _estimate.Forget();
    }
}

// Accounts for the bytes sent since the last call that were not paid for yet.
void AirTraffic::Watch(Duration now)
{
    const Duration before = std::exchange(_watchedAt, now);
    const std::size_t bytes = TakeSent();
    if (bytes == 0)
    {
        return;
    }
    // Without a limit these bytes were sent when this node last served its streams, which may be long ago.
    _estimate.Sent(bytes, IsScheduled() ? now : std::max(_servedAt, before));
    if (IsLimited())
    {
        _unscheduled.Add(bytes, before, now);
        _schedule.Spent(bytes, now);
    }
}

bool AirTraffic::IsBeatWorth(Duration now) const
{
    return _beats.IsWorthABeat(now) && !_config.Radio.Budget;
}

std::size_t AirTraffic::SendBeat(std::size_t most, Duration now)
{
    _beats.BeatSent(now);
    return _presence.SendBeat(now, std::min(most, BeatFormat::Largest));
}

void AirTraffic::SetLimit(Duration now)
{
    _limitSetAt = now;
    const Duration discoveryLate = _turns != nullptr ? _turns->QueueingDelay() : Duration(0);
    _presence.HeardLate(discoveryLate);
    static_assert(DelayNotes::LongDelay <= CapacityEstimate::LongWait,
                  "the estimate hears of each long wait");
    _estimate.HeardLate(discoveryLate, _presence.LongDelay(now), now);
    const std::optional<double> carried = _estimate.Rate(now);
    const std::optional<double> budget = _config.Radio.Budget;
    _presence.SetBeatPeriod(
        BeatRate::PeriodOf(_beats.BeatBytes(), budget, _config.Radio.SlowestBeat, carried));
    if (budget)
    {
        _schedule.Reserve(_unscheduled.Rate(now));
    }
    _schedule.SetLimits(budget, carried, now);
}

Duration AirTraffic::ServeUnlimited(Duration now)
{
    _servedAt = now;
    while (_turns != nullptr && _turns->IsDue() && _turns->NextBytes() > 0)
    {
        _turns->SendNext();
    }
    Duration beatDue = _presence.BeatDue();
    if (now >= beatDue || IsBeatWorth(now))
    {
        SendBeat(BeatFormat::Largest, now);
        beatDue = _presence.BeatDue();
    }
    Duration next = std::min({beatDue, _links.Service(), _types.Service(now), _foreign.SendAll(now)});
    for (TopicPublisher &publisher : _publishers)
    {
        next = std::min(next, publisher.Service(Now()));
    }
    return next;
}

// With a budget the schedule keeps the promise (LookAtBeat). A pace is an estimate, but a missed deadline
// certainly makes this node LOST at its peers: the beat is sent, whatever the pace.
void AirTraffic::KeepPromise(Duration now)
{
    if (IsLimited() && !_config.Radio.Budget && now >= _presence.BeatPromised())
    {
        SendBeat(_cost.BodyWithin(AirBudget::SmallestDatagram, false), now);
        const std::size_t bytes = TakeSent();
        _estimate.Sent(bytes, now);
        _schedule.Spent(bytes, now);
        _schedule.NotReady(_beat);
    }
}

void AirTraffic::LookAtBeat(Duration now)
{
    KeepPromise(now);
    if (now >= _presence.BeatDue() || IsBeatWorth(now))
    {
        _schedule.Ready(_beat, BeatBytes(now));
    }
    else if (_merges && now >= _presence.BeatPromised() - _presence.BeatPeriod() / EarlyPart)
    {
        _schedule.MayRide(_beat, BeatBytes(now));
    }
    if (_config.Radio.Budget)
    {
        _schedule.Promise(_beat, BeatBytes(now), _presence.BeatPromised());
    }
}

// A beat may be sent as soon as one of the usual size fits, and a part of the announcement, if one is due. It
// carries as much as there is room for, and the rest goes with the next beats.
std::size_t AirTraffic::BeatBytes(Duration now) const
{
    const AirCost::Readers readers{.Destinations = _presence.BeatCopies()};
    const std::size_t least = _cost.Of(_presence.LeastBeatSize(now), readers);
    return std::min(std::max(static_cast<std::size_t>(_beats.BeatBytes()), least),
                    _cost.Of(_presence.BeatSize(now), readers));
}

// Returns the room for each copy of a beat. With a limit the copies share the room of one datagram, but each
// has room for a small beat: a part of the announcement would never fit else. Many copies then take more than
// a datagram, and the next datagrams wait longer.
std::size_t AirTraffic::BeatRoom(Duration now)
{
    const std::size_t copies = _presence.BeatCopies();
    const std::size_t most = std::max(_schedule.Budget().LargestDatagram(), AirBudget::SmallestDatagram);
    const std::size_t least = _cost.Of(std::max(SmallBeat, _presence.LeastBeatSize(now)));
    const std::size_t all = IsLimited() ? std::max(most, copies * least) : copies * most;
    return _schedule.Room(all, now) / copies;
}

void AirTraffic::LookAt(std::size_t publisher, Duration now)
{
    TopicPublisher &of = _publishers[publisher];
    bool isDue = false;
    if (_mirrored != Mirrored::Nothing)
    {
        of.Fetch();
        isDue = of.DueAt(now) <= now && (_mirrored == Mirrored::All || MayCopy(of, now));
    }
    if (isDue)
    {
        _schedule.Ready(_publisherStreams[publisher], of.NextBytes(_cost));
    }
    else
    {
        _schedule.NotReady(_publisherStreams[publisher]);
    }
}

// Of values that go by another path, too. They go while KeptShare of a budget is free, since copies of queue
// messages have no turns. A copy's own size does not matter here: by it small copies would always go before
// larger ones, and the schedule would have no choice.
bool AirTraffic::MayCopy(const TopicPublisher &publisher, Duration now)
{
    const auto kept = static_cast<std::size_t>(KeptShare * _config.Radio.Budget.value_or(0.0));
    return ImportanceOf(publisher.Rule()) != TrafficClass::Bulk && _schedule.MaySend(kept, now);
}

void AirTraffic::LookAtTypes(Duration now)
{
    const std::optional<Duration> due = _types.Due();
    if (due && *due <= now)
    {
        const std::size_t most = _cost.BodyWithin(_schedule.Budget().LargestDatagram(), true);
        _schedule.Ready(_typeTexts, _cost.Of(_types.NextBody(most), {.Destinations = 1, .Directed = true}));
    }
    else
    {
        _schedule.NotReady(_typeTexts);
    }
}

void AirTraffic::LookAtCards()
{
    _cardBytes = _turns != nullptr && _turns->IsDue() ? _turns->NextBytes() : 0;
    _cardBytes > 0 ? _schedule.Ready(_cards, _cardBytes) : _schedule.NotReady(_cards);
}

Duration AirTraffic::ServeLimited()
{
    const Duration linksDue = _links.Advance();
    const Duration now = Now();
    _merges = IsMerging(now);
    LookAtBeat(now);
    _mirrored = _choice.CarriesAny(_path)           ? Mirrored::All
                : _choice.IsSecondOfAny(_path, now) ? Mirrored::Copies
                                                    : Mirrored::Nothing;
    for (std::size_t i = 0; i < _publishers.size(); ++i)
    {
        LookAt(i, now);
    }
    LookAtTypes(now);
    LookAtCards();
    _linkStreams.Look(_schedule.Budget().LargestDatagram(), now);
    _foreign.Look(now);
    while (const auto chosen = _schedule.Next(now))
    {
        SendTurn(*chosen, now);
    }
    Duration next = std::min(_schedule.NextDue(now), linksDue > now ? linksDue : now + LookPeriod);
    next = _mirrored == Mirrored::Copies ? std::min(next, now + LookPeriod) : next;
    next = _estimate.Rate(now) ? std::min(next, now + LimitPeriod) : next;
    for (const Duration beat : {_presence.BeatDue(), _presence.BeatPromised()})
    {
        next = beat > now ? std::min(next, beat) : next;
    }
    const Duration types = _types.Due().value_or(now);
    next = types > now ? std::min(next, types) : next;
    for (const TopicPublisher &publisher : _publishers)
    {
        const Duration due = _mirrored != Mirrored::Nothing ? publisher.DueAt(now) : now;
        next = due > now ? std::min(next, due) : next;
    }
    next = std::min(next, _foreign.NextDue(now));
    _links.WillServe(next);
    return next;
}

std::size_t AirTraffic::Send(StreamId id, std::optional<std::size_t> joins, Duration now)
{
    const std::size_t largest = _schedule.Budget().LargestDatagram();
    const std::size_t most = joins ? std::min(largest, *joins + AirSchedule::JoinedHeaders) : largest;
    std::size_t publisher = _publishers.size();
    bool sent = true;
    bool isForeign = false;
    if (id == _beat)
    {
        const std::size_t room = BeatRoom(now);
        SendBeat(_cost.BodyWithin(joins ? std::min(most, room) : room, false), now);
    }
    else if (id == _typeTexts)
    {
        _types.SendOne(_cost.BodyWithin(most, true), now);
    }
    else if (id == _cards)
    {
        _turns->SendNext();
    }
    else if (_foreign.Send(id, now))
    {
        isForeign = true;
    }
    else if (!_linkStreams.Send(id, most, now, sent))
    {
        publisher = static_cast<std::size_t>(
            std::find(_publisherStreams.begin(), _publisherStreams.end(), id) - _publisherStreams.begin());
        _publishers[publisher].Fetch();
        _publishers[publisher].WriteNext(now);
    }
    const std::size_t bytes = TakeSent();
    _estimate.Sent(bytes, now);
    // A card to listed peers goes to each of them: more bytes than it was given a turn for.
    const std::size_t ofTurn = id == _cards ? std::min(bytes, _cardBytes) : bytes;
    _schedule.Sent(id, ofTurn, now);
    _schedule.Spent(bytes - ofTurn, now);
    if (publisher < _publishers.size())
    {
        LookAt(publisher, now);
    }
    else if (id == _beat)
    {
        // The period follows the bytes of a beat that goes alone, so that the others may use what is saved.
        _beats.BeatTook(bytes + (joins ? _presence.BeatCopies() * AirSchedule::JoinedHeaders : 0));
        LookAtBeat(now);
    }
    else if (id == _typeTexts)
    {
        LookAtTypes(now);
    }
    else if (id == _cards)
    {
        LookAtCards();
    }
    else if (isForeign)
    {
        _foreign.Look(now);
    }
    else if (sent)
    {
        _linkStreams.Look(largest, now);
    }
    return bytes;
}

Gateway::AirStatus AirTraffic::Report(Gateway::Fleet &fleet, Duration now)
{
    const auto carries = [this](std::string_view node) { return _choice.Of(node) == _path; };
    _links.VisitPaths(
        [&fleet, &carries](std::string_view node, const LinkPathState &path)
        {
            Gateway::NodeStatus *const status = carries(node) ? FleetReport::NodeIn(fleet, node) : nullptr;
            if (status != nullptr && path.DeliveryRate > 0)
            {
                status->delivery_rate = path.DeliveryRate;
            }
        });
    return _report.Fill(_session->Counters(), _estimate.Rate(now), _publishers, SentByStreams(), carries,
                        fleet, now);
}

}  // namespace Rabit
