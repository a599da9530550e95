#include "presence/Presence.h"

#include <algorithm>
#include <utility>

#include "clocks/GpsTime.h"
#include "wire/Announcements.h"
#include "wire/GatewayTopics.h"
#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

// However many ask for the announcement, it goes to all of them, and not more often than this.
constexpr Presence::Duration AnnouncementGap = std::chrono::milliseconds(500);
// One beat goes to everybody; with more nodes than this they take turns to be echoed, and to be asked.
constexpr std::size_t EchoesInABeat = 2;
constexpr std::size_t WantsInABeat = 4;

}  // namespace

Presence::Presence(const std::string &node, std::uint64_t incarnation, const RabitClock &clock,
                   const SourceClock &source, OriginTable &origins, RemoteQueues &remote,
                   SenderCheck &senders, RandomSource random, PeerTable::IsNeeded isNeeded,
                   std::function<void()> wake)
    : _node(node),
      _incarnation(incarnation),
      _clock(clock),
      _source(source),
      _origins(origins),
      _remote(remote),
      _wake(std::move(wake)),
      _peers(node, incarnation, std::move(isNeeded)),
      _introductions(std::move(random)),
      _inbox(senders)
{
}

Presence::~Presence()
{
    // The handlers use the rest.
    _beatReader.reset();
    _announcementReader.reset();
}

void Presence::Open(TransportSession &session, Gateway::Announcement announcement)
{
    _announcement = std::move(announcement);
    _announcementDigest = Announcements::DigestOf(_announcement);
    _nextAnnouncement = Duration(0);
    _states.assign(Announcements::StatesIn(_announcement), 0);
    const auto open = [&session](const char *topic, const MessageType &type, QosProfile profile, auto &writer)
    {
        writer =
            session.CreateWriter(GatewayTopics::Describe(topic, type), GatewayTopics::QosOf(profile), {});
    };
    open(GatewayTopics::Beat, GatewayTopics::TypeOf<Gateway::Beat>(), QosProfile::Telemetry, _beatWriter);
    open(GatewayTopics::Announcement, GatewayTopics::TypeOf<Gateway::Announcement>(), QosProfile::State,
         _announcementWriter);
    _beatReader = session.CreateReader(
        GatewayTopics::Describe(GatewayTopics::Beat, GatewayTopics::TypeOf<Gateway::Beat>()),
        GatewayTopics::QosOf(QosProfile::Telemetry), {},
        [this](SampleBytes bytes, const SampleInfo &info)
        { WakeIf(info.Alive && _inbox.AddBeat(bytes, info.Node, _clock.Monotonic())); });
    _announcementReader = session.CreateReader(
        GatewayTopics::Describe(GatewayTopics::Announcement, GatewayTopics::TypeOf<Gateway::Announcement>()),
        GatewayTopics::QosOf(QosProfile::State), {},
        [this](SampleBytes bytes, const SampleInfo &info)
        { WakeIf(info.Alive && _inbox.AddAnnouncement(bytes, info.Node, _clock.Monotonic())); });
}

void Presence::Close()
{
    if (_announcementWriter)
    {
        _announcement.leaving = true;
        SendAnnouncement(_clock.Monotonic());
    }
    _beatReader.reset();
    _announcementReader.reset();
    _beatWriter.reset();
    _announcementWriter.reset();
}

void Presence::OnPeer(const PeerEvent &event)
{
    WakeIf(_inbox.AddEvent(event));
}

void Presence::WakeIf(bool somethingCame)
{
    if (somethingCame)
    {
        _wake();
    }
}

PeerTable::Change Presence::TakeIn(const PresenceInbox::Contents &inbox, Duration now)
{
    PeerTable::Change all;
    const auto note = [&all, this](const PeerTable::Change &change, const std::string &node)
    {
        all.State |= change.State;
        all.NewLife |= change.NewLife;
        all.Offers |= change.Offers;
        for (const std::string &forgotten : change.Forgotten)
        {
            _remote.Forget(forgotten);
            _origins.Forget(forgotten);
            all.Forgotten.push_back(forgotten);
        }
        Publish(node);
    };
    for (const Gateway::Announcement &announcement : inbox.Announcements)
    {
        note(_peers.OnAnnouncement(announcement, now), announcement.node);
    }
    for (const PresenceInbox::Heard &heard : inbox.Beats)
    {
        const PeerTable::Change change = _peers.OnBeat(heard.Beat, heard.Arrival);
        note(change, heard.Beat.node);
        if (std::find(heard.Beat.wants.begin(), heard.Beat.wants.end(), _node) != heard.Beat.wants.end())
        {
            _nextAnnouncement =
                std::min(_nextAnnouncement, std::max(now, _lastAnnouncement + AnnouncementGap));
        }
        if (change.NewLife)
        {
            _introductions.Ask(heard.Beat.node, Introductions::Reason::Heard, OthersThan(heard.Beat.node),
                               now);
        }
    }
    for (const PeerEvent &event : inbox.Events)
    {
        if (event.What == PeerEvent::Kind::Left)
        {
            note(_peers.OnLeft(event.Node, event.Incarnation), event.Node);
        }
        // Whoever has just appeared wants to know who is here.
        if (event.What == PeerEvent::Kind::Appeared)
        {
            _introductions.Ask(event.Node, Introductions::Reason::Appeared, OthersThan(event.Node), now);
        }
    }
    return all;
}

std::size_t Presence::OthersThan(const std::string &node) const
{
    const auto heard = _peers.Heard();
    return static_cast<std::size_t>(std::count_if(heard.begin(), heard.end(),
                                                  [&node](const PeerTable::Peer *peer) {
                                                      return peer->State != Gateway::NodeState::LOST &&
                                                             peer->Node != node;
                                                  }));
}

// Hands what is known of a node to those who read it on other threads.
void Presence::Publish(const std::string &node)
{
    const PeerTable::Peer *peer = _peers.Find(node);
    if (peer == nullptr)
    {
        return;
    }
    _remote.Update(*peer);
    const std::optional<PeerClock::SourceRelation> source = peer->Clock.Source();
    if (peer->Heard && source)
    {
        _origins.Set(node, OriginTable::Origin{peer->Incarnation, *source, peer->Clock.SourceToWall()});
    }
}

Presence::Served Presence::Service(Duration now)
{
    Served served;
    PeerTable::Change &change = served.Change;
    change = TakeIn(_inbox.Take(), now);
    if (_peers.Advance(now).State)
    {
        change.State = true;
    }
    if (change.State)
    {
        for (const PeerTable::Peer *peer : _peers.Heard())
        {
            _remote.Update(*peer);
        }
    }
    if (_introductions.TakeBeats(now))
    {
        _pace.Introduce(now);
    }
    served.RepeatStates = _introductions.TakeStates(now);
    if (now >= _nextAnnouncement)
    {
        SendAnnouncement(now);
    }
    return served;
}

Presence::Duration Presence::BeatDue() const
{
    return _pace.Due();
}

std::size_t Presence::BeatSize(Duration /*now*/) const
{
    return LargestBeat;
}

std::size_t Presence::SendBeat(Duration now, std::size_t /*most*/)
{
    if (!_beatWriter)
    {
        return 0;
    }
    // All clocks read at one moment: the others compute one from the other.
    const PostTime time = _clock.Now();
    const std::int64_t utc = GpsTime::ToUtcNanoseconds(time.GpsTimeSeconds);
    Gateway::Beat beat;
    beat.node = _node;
    beat.incarnation = _incarnation;
    beat.monotonic_ns = time.Monotonic.count();
    beat.source_ns = _source.At(time.Monotonic);
    beat.utc_ns = utc;
    beat.offers = _announcementDigest;
    beat.wants = _peers.NextWanted(time.Monotonic, WantsInABeat);
    beat.echoes = _peers.NextEchoes(time.Monotonic, EchoesInABeat);
    const MessageEncoder encoder(GatewayTopics::TypeOf<Gateway::Beat>(), beat);
    static_cast<void>(_beatWriter->Write(encoder, utc));
    _pace.Sent(now);
    return encoder.EncodedSize() - 4;
}

void Presence::SetStateVersion(std::size_t state, std::uint32_t version)
{
    _states.at(state) = version;
}

void Presence::WantStates(const std::string &node, const std::vector<bool> &states, Duration /*now*/)
{
    _wantsStates[node] = states;
}

void Presence::SendAnnouncement(Duration now)
{
    if (!_announcementWriter)
    {
        return;
    }
    const std::int64_t utc = GpsTime::ToUtcNanoseconds(_clock.GpsTimeSeconds());
    const WriteResult result = _announcementWriter->Write(
        MessageEncoder(GatewayTopics::TypeOf<Gateway::Announcement>(), _announcement), utc);
    _lastAnnouncement = now;
    _nextAnnouncement = result == WriteResult::Ok ? Duration::max() : now + AnnouncementGap;
}

Presence::Duration Presence::NextDue() const
{
    Duration next = _nextAnnouncement;
    for (const std::optional<Duration> &due : {_peers.NextChange(), _introductions.Due()})
    {
        next = due ? std::min(next, *due) : next;
    }
    return next;
}

}  // namespace Rabit
