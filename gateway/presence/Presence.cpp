#include "presence/Presence.h"

#include <algorithm>
#include <utility>

#include "clocks/GpsTime.h"
#include "names/NodeTag.h"
#include "wire/Announcements.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"
#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

// A goodbye is not retransmitted, so it is sent three times; the transport tells the others of the end as
// well.
constexpr int Goodbyes = 3;
constexpr std::size_t Encapsulation = 4;

template <typename Items>
void KeepOneOfEach(Items &items)
{
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

Presence::Presence(const std::string &node, std::uint64_t incarnation, const RabitClock &clock,
                   const SourceClock &source, OriginTable &origins, RemoteQueues &remote, RandomSource random,
                   PeerTable::IsNeeded isNeeded, std::function<void()> wake, SpeaksOf speaksOf)
    : _node(node),
      _tag(NodeTagOf(node, incarnation)),
      _clock(clock),
      _source(source),
      _origins(origins),
      _remote(remote),
      _wake(std::move(wake)),
      _speaksOf(std::move(speaksOf)),
      _peers(node, incarnation, std::move(isNeeded)),
      _introductions(random),
      _contents(_peers, std::move(random))
{
}

Presence::~Presence()
{
    _reader.reset();  // its handler uses the rest
}

void Presence::BeTool(PeerTable::IsAsked asksOf)
{
    _isTool = true;
    _contents.BeTool();
    _peers.BeTool(std::move(asksOf));
    _peers.Missing().BeQuick(ToolGap, ToolQuestions);
    _pace.SetLongestGap(ToolGap);
    SetBeatPeriod(BeatPeriod());
}

void Presence::Open(TransportSession &session, const Gateway::Announcement &announcement)
{
    _contents.Begin(Announcements::Encode(announcement), Announcements::StatesIn(announcement));
    const TopicDescription topic =
        GatewayTopics::Describe(GatewayTopics::Beat, GatewayTopics::TypeOf<Gateway::Beat>());
    const TopicQos qos = GatewayTopics::QosOf(QosProfile::Telemetry);
    _writer = session.CreateWriter(topic, qos, {});
    _reader = session.CreateReader(topic, qos, {},
                                   [this](SampleBytes bytes, const SampleInfo &info) {
                                       WakeIf(info.Alive && _inbox.AddBeat(bytes, info, _clock.Monotonic()));
                                   });
}

void Presence::Close()
{
    if (_writer)
    {
        const PostTime time = _clock.Now();
        Gateway::Beat goodbye = MakeBeat(time);
        goodbye.leaving = true;
        if (_isTool)
        {
            BeatExtensions::MarkTool(goodbye);
        }
        for (int i = 0; i < Goodbyes && Write(goodbye, time) == WriteResult::Ok; ++i)
        {
        }
    }
    _reader.reset();
    _writer.reset();
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

void Presence::Served::Clear()
{
    Change.Beat = Change.State = Change.NewLife = Change.Offers = false;
    Change.Forgotten.clear();
    StatesTold.clear();
    StatesAsked.clear();
    Delays.clear();
    NothingLate.clear();
    Agreements.clear();
    TypesAsked.clear();
}

const Presence::Served &Presence::Service(Duration now)
{
    Served &served = _served;
    if (served.Any())
    {
        served.Clear();
    }
    if (!_inbox.IsEmpty())
    {
        TakeIn(_inbox.Take(), now, served);
    }
    Note(_peers.Advance(now), "", served);
    if (served.Change.State)
    {
        for (const PeerTable::Peer *peer : _peers.Heard())
        {
            if (_speaksOf(peer->Node))
            {
                _remote.Update(*peer);
            }
            if (peer->State == Gateway::NodeState::LOST)
            {
                _contents.Types().Forget(peer->Node);
            }
        }
    }
    if (now >= _lookAt || _watch.IsExpecting())
    {
        _lookAt = now + (_watch.IsExpecting() ? ReaderWatch::Period : ReaderWatch::Memory / 2);
        if (_watch.Look(_writer ? _writer->MatchedReaders() : 0, now))
        {
            _introductions.Begin(OthersThan(""), now);
        }
    }
    if (_introductions.TakeBeats(now))
    {
        _pace.Introduce(now);
    }
    // The sum changes only with a state or an incarnation.
    if (_contents.HasToolCome() || (_peers.Tools() > 0 && (served.Change.State || served.Change.NewLife)))
    {
        _contents.LookAtFleet();
    }
    return served;
}

void Presence::TakeIn(const PresenceInbox::Contents &inbox, Duration now, Served &served)
{
    for (const HeardBeat &heard : inbox.Beats)
    {
        TakeIn(heard, now, served);
    }
    for (const PeerEvent &event : inbox.Events)
    {
        TakeIn(event, now, served);
    }
    for (const std::string &node : inbox.OtherFormats)
    {
        _otherFormats.Note({"node " + node, node,
                            "its gateway speaks another version of presence than this one: neither knows "
                            "what the other has"},
                           now);
    }
    KeepOneOfEach(served.StatesTold);
    KeepOneOfEach(served.StatesAsked);
}

void Presence::TakeIn(const HeardBeat &heard, Duration now, Served &served)
{
    const PeerTable::Change change = _peers.OnBeat(heard);
    Note(change, heard.Node, served);
    if (!change.Beat)
    {
        return;
    }
    const PeerTable::Peer &peer = *_peers.Find(heard.Node);
    if (change.NewLife)
    {
        _contents.RepeatProblems();
    }
    if (peer.IsTool)
    {
        TakeDelays(heard, peer, served);
        TakeQuestions(heard, now, served);
        return;
    }
    _owesNews |= _contents.Delays().Note(peer.Tag, peer.Clock.LastDelay(), heard.Arrival);
    TakeDelays(heard, peer, served);
    TakeQuestions(heard, now, served);
    if (_contents.HasAgreement() && peer.Agreement)
    {
        served.Agreements.push_back({heard.Node, heard.Incarnation, *peer.Agreement});
    }
    if (!NewsOf(heard.Beat).states.empty() || change.Offers)
    {
        served.StatesTold.push_back(heard.Node);
    }
    if (change.NewLife)
    {
        _contents.Questions().Forget(heard.Node);
        const std::size_t others = OthersThan(heard.Node);
        if (!_isTool && _introductions.Ask(heard.Node, Introductions::Reason::Heard, others, now))
        {
            _contents.Answer().Asked(0, others, now);
        }
    }
}

void Presence::TakeQuestions(const HeardBeat &heard, Duration now, Served &served)
{
    const Gateway::Beat &beat = heard.Beat;
    if (!NewsOf(beat).wants.empty())
    {
        for (const BeatExtensions::TypeQuestion &question : BeatExtensions::TypeQuestionsIn(beat))
        {
            if (question.Node == _tag)
            {
                served.TypesAsked.emplace_back(heard.Node, question);
            }
        }
    }
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
    {
        if (wanted.node != _tag)
        {
            continue;
        }
        if (wanted.offers != BeatFormat::NotLacking)
        {
            _contents.Answer().Asked(wanted.offers, OthersThan(""), now,
                                     NodeTagOf(heard.Node, heard.Incarnation));
        }
        for (std::size_t state = 0; state < 8 * wanted.states.size() && state < _contents.States(); ++state)
        {
            if ((wanted.states[state / 8] >> state % 8 & 1) != 0)
            {
                served.StatesAsked.push_back(state);
            }
        }
        return;  // once is enough
    }
}

void Presence::TakeDelays(const HeardBeat &heard, const PeerTable::Peer &peer, Served &served) const
{
    for (const Gateway::DelayReport &report : NewsOf(heard.Beat).delays)
    {
        if (report.node == _tag)
        {
            const Duration held = std::chrono::milliseconds(report.held_ms);
            served.Delays.push_back({.Peer = peer.Tag,
                                     .Node = peer.Node,
                                     .Delay = std::chrono::milliseconds(report.delay_ms),
                                     .ArrivedAt = heard.Arrival - held - peer.Clock.LastDelay()});
            return;
        }
    }
    if (BeatFormat::TellsOfAllDelays(NewsOf(heard.Beat).delays.size()))
    {
        served.NothingLate.emplace_back(peer.Tag, heard.Arrival - peer.Clock.LastDelay());
    }
}

void Presence::TakeIn(const PeerEvent &event, Duration now, Served &served)
{
    if (event.What == PeerEvent::Kind::Left)
    {
        Note(_peers.OnLeft(event.Node, event.Incarnation), event.Node, served);
        if (_peers.Find(event.Node) == nullptr)
        {
            // A sample of the tool may have come after its goodbye.
            served.Change.Forgotten.push_back(event.Node);
        }
    }
    // A node that has just appeared needs the beats of the others.
    if (!_isTool && event.What == PeerEvent::Kind::Appeared &&
        _introductions.Grant(event.Node, Introductions::Reason::Appeared, now))
    {
        _watch.Expect(now);
    }
}

void Presence::Note(const PeerTable::Change &change, const std::string &node, Served &served)
{
    served.Change.Beat |= change.Beat;
    served.Change.State |= change.State;
    served.Change.NewLife |= change.NewLife;
    served.Change.Offers |= change.Offers;
    for (const std::string &forgotten : change.Forgotten)
    {
        if (_speaksOf(forgotten))
        {
            _remote.Forget(forgotten);
            _origins.Forget(forgotten);
        }
        _contents.Questions().Forget(forgotten);
        _contents.Types().Forget(forgotten);
        served.Change.Forgotten.push_back(forgotten);
    }
    const PeerTable::Peer *const peer = _peers.Find(node);
    if (peer != nullptr && !peer->IsTool && _speaksOf(node))
    {
        Publish(*peer, change.State || change.NewLife || change.Offers);
    }
}

// Number of live nodes besides `node` and this one.
std::size_t Presence::OthersThan(const std::string &node) const
{
    const auto heard = _peers.Heard();
    return static_cast<std::size_t>(std::count_if(heard.begin(), heard.end(),
                                                  [&node](const PeerTable::Peer *peer) {
                                                      return peer->State != Gateway::NodeState::LOST &&
                                                             peer->Node != node;
                                                  }));
}

// Hands the facts about a node to the tables that other threads read.
void Presence::Publish(const PeerTable::Peer &peer, bool offers)
{
    if (offers)
    {
        _remote.Update(peer);
    }
    if (const std::optional<PeerClock::SourceRelation> source = peer.Clock.Source())
    {
        _origins.Set(peer.Node, OriginTable::Origin{peer.Incarnation, *source, peer.Clock.SourceToWall()});
    }
}

void Presence::Publish(const std::string &node)
{
    const PeerTable::Peer *const peer = _peers.Find(node);
    if (peer != nullptr && !peer->IsTool)
    {
        Publish(*peer, true);
    }
}

Presence::Duration Presence::NextDue() const
{
    Duration next = Duration::max();
    for (const std::optional<Duration> &due : {_peers.NextChange(), _introductions.Due(),
                                               _watch.IsExpecting() ? std::optional(_lookAt) : std::nullopt})
    {
        next = due ? std::min(next, *due) : next;
    }
    return next;
}

Presence::Duration Presence::BeatDue() const
{
    Duration due = _pace.Due();
    if (const std::optional<Duration> question = _contents.QuestionDue())
    {
        due = std::min(due, std::max(*question, _pace.EarliestToAsk()));
    }
    if (_owesNews)
    {
        due = std::min(due, _pace.EarliestToAsk());
    }
    if (const std::optional<Duration> answer = _contents.AnswerDue())
    {
        due = std::min(due, std::max(*answer, _pace.Earliest()));
    }
    return due;
}

void Presence::NoteDelay(std::string_view node, Duration delay, Duration arrivedAt)
{
    if (const PeerTable::Peer *peer = _peers.Find(std::string(node)))
    {
        _owesNews |= _contents.Delays().Note(peer->Tag, delay, arrivedAt);
    }
}

void Presence::SetFirstHeard(const std::vector<std::string> &nodes)
{
    std::vector<std::uint32_t> tags;  // of their present incarnations
    for (const std::string &node : nodes)
    {
        if (const PeerTable::Peer *peer = _peers.Find(node))
        {
            tags.push_back(peer->Tag);
        }
    }
    std::sort(tags.begin(), tags.end());
    if (tags != _firstHeard)
    {
        _firstHeard = tags;
        _contents.SetFirstHeard(std::move(tags));
        _owesNews = true;
    }
}

// Both clocks are read at one moment: receivers compute one from the other.
Gateway::Beat Presence::MakeBeat(const PostTime &time) const
{
    Gateway::Beat beat;
    beat.format = BeatFormat::Present;
    beat.next_ms = static_cast<std::uint16_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(_pace.Period()).count());
    beat.source_ns = _source.At(time.Monotonic);
    beat.offers = _contents.OffersDigest();
    DropEmptyNews(beat);
    return beat;
}

WriteResult Presence::Write(const Gateway::Beat &beat, const PostTime &time)
{
    const MessageEncoder encoder(GatewayTopics::TypeOf<Gateway::Beat>(), beat);
    return _writer->Write(encoder, GpsTime::ToUtcNanoseconds(time.GpsTimeSeconds));
}

std::size_t Presence::BeatCopies() const
{
    return static_cast<std::size_t>(std::max(_writer ? _writer->Destinations() : 0, 1));
}

std::size_t Presence::SessionsOf(std::string_view node) const
{
    const PeerTable::Peer *const peer = _peers.Find(std::string(node));
    return peer != nullptr && peer->Twice ? 2 : 1;
}

std::size_t Presence::SendBeat(Duration now, std::size_t most)
{
    if (!_writer)
    {
        return 0;
    }
    const bool isDue = now >= BeatDue();
    const std::optional<Duration> question = _contents.QuestionDue();
    const bool isWanted = _owesNews || (question && *question <= now);
    const PostTime time = _clock.Now();
    Gateway::Beat beat = MakeBeat(time);
    _contents.Fill(beat, time.Monotonic, most);
    _owesNews = false;
    _peers.NoteSent(beat.source_ns, time.Monotonic);
    static_cast<void>(Write(beat, time));
    isDue ? _pace.Sent(now, _contents.Delays().Delay(now), isWanted) : _pace.SentEarly(now);
    return GatewayTopics::TypeOf<Gateway::Beat>().SerializedSize(beat) - Encapsulation;
}

}  // namespace Rabit
