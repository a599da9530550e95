#include "GuardedNode.h"

#include <algorithm>

#include "Words.h"
#include "common/ParticipantIdentity.h"
#include "common/RtpsTraffic.h"

namespace Opponent
{

using namespace RtpsBytes;
using namespace Rabit::Rtps;

namespace
{

constexpr EntityId BeatWriter = 0x00000103;
constexpr EntityId BeatReader = 0x00000204;
constexpr std::uint8_t HasData = 5;

GuidPrefix NameOf(std::uint8_t number)
{
    GuidPrefix name{1, 15, 0x33};
    name.back() = number;
    return name;
}

// A locator: its kind, its port, and 16 bytes of address (OMG DDSI-RTPS 2.3, 9.3.2).
Rabit::Rtps::Place PlaceIn(std::span<const std::uint8_t> locator)
{
    Rabit::Rtps::Place place;
    place.Port = static_cast<std::uint16_t>(locator[4] | locator[5] << 8);
    std::copy_n(locator.begin() + 20, place.Host.size(), place.Host.begin());
    return place;
}

Bytes UserData(std::uint8_t number)
{
    const std::string text = Rabit::MakeUserData(number, true);
    Bytes bytes = Join({U32(static_cast<std::uint32_t>(text.size())), Bytes(text.begin(), text.end())});
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
}

}  // namespace

void Vendor::Receive(std::span<std::uint8_t> message, TimePoint now)
{
    const GuidPrefix from = SenderOf(message);
    bool walkable = true;
    bool announced = false;
    VisitSubmessages(message,
                     [&](const Rabit::Rtps::Submessage &part)
                     {
                         const auto said = IsDelivery(part.Kind) ? CheckDelivery(part) : std::nullopt;
                         if (!said)
                         {
                             return;
                         }
                         if (said->Writer == BeatWriter && part.Kind == SubmessageKind::Data)
                         {
                             Beats[from] = now;
                         }
                         Peer &peer = _peers[from];
                         if (part.Kind == SubmessageKind::Data && IsBuiltin(said->Writer))
                         {
                             announced = true;
                             Announced(peer, *said, part);
                         }
                         if (part.Kind == SubmessageKind::Heartbeat || part.Kind == SubmessageKind::Gap)
                         {
                             walkable = IsWalkable(peer, part.Kind, *said) && walkable;
                         }
                     });
    if (walkable)
    {
        Dds.Receive(message);
    }
    if (!Dds.Knows(from))
    {
        _peers.erase(from);
    }
    if (announced)
    {
        FindReaders();
    }
}

void Vendor::Announced(Peer &peer, const Delivery &said, const Rabit::Rtps::Submessage &part)
{
    auto &highest = peer.Highest[said.Writer];
    highest = std::max(highest, said.First);
    if (said.Writer == ParticipantWriter)
    {
        VisitParameters(said.Payload,
                        [&](const ListParameter &parameter)
                        {
                            if (parameter.Id == Parameters::DefaultUnicastLocator)
                            {
                                peer.At = PlaceIn(parameter.Value);
                            }
                        });
        return;
    }
    const std::pair key(said.Writer, SubjectOf(part.Whole));
    if (said.Alive)
    {
        peer.Endpoints[key].assign(part.Whole.begin(), part.Whole.end());
    }
    else
    {
        peer.Endpoints.erase(key);
    }
}

// A heartbeat says that all before its first number are absent, a gap that its own are.
bool Vendor::IsWalkable(Peer &peer, SubmessageKind kind, const Delivery &said)
{
    auto &highest = peer.Highest[said.Writer];
    const std::int64_t absent = kind == SubmessageKind::Heartbeat ? said.First - 1 : said.Last;
    Walked += static_cast<std::uint64_t>(std::max<std::int64_t>(absent - highest, 0));
    highest = std::max(highest, absent);
    return said.Last <= Farthest;
}

std::optional<Rabit::Rtps::Place> Vendor::PlaceOf(const GuidPrefix &name) const
{
    const auto found = _peers.find(name);
    return found == _peers.end() ? std::nullopt : found->second.At;
}

void Vendor::FindReaders()
{
    _readers.clear();
    for (const auto &[name, peer] : _peers)
    {
        const bool reads =
            std::any_of(peer.Endpoints.begin(), peer.Endpoints.end(),
                        [](const auto &each) { return each.first.first == SubscriptionsWriter; });
        if (reads && peer.At)
        {
            _readers.insert(*peer.At);
        }
    }
}

GuardedNode::GuardedNode(std::uint8_t number, std::function<void(const Bytes &)> send)
    : Name(NameOf(number)),
      Host{10, 77, 0, number},
      Dds(Name, [this](const Bytes &message) { FromVendor(message); }),
      _send(std::move(send)),
      _meeting({.Period = Period, .Memory = std::chrono::hours(4)}),
      _guard(RtpsGuard::Mode::Full, Period)
{
    _guard.SetObserver(*this);
    Dds.Dds.AddWriter(BeatWriter);
}

void GuardedNode::Send(const Bytes &datagram)
{
    SentBytes += datagram.size() + CardExchange::IpAndUdp;
    _send(datagram);
}

void GuardedNode::FromVendor(const Bytes &message)
{
    _guard.Sending(message);
    const auto to = Dds.PlaceOf(Rabit::DestinationOf(message));
    if (!_meeting.Sending(message, _now) &&
        (!to || _guard.MayGo(*to, message.size(), Rabit::Rtps::Ledger::Cargo::Discovery, _addresses, _now)))
    {
        Send(message);
    }
}

void GuardedNode::Announce()
{
    const Place place{.Host = Host.back(), .Port = 7411};
    Bytes data = ParticipantData(Name, place);
    const Bytes userData = Parameter(Parameters::UserData, UserData(Host.back()));
    data.insert(data.end() - 4, userData.begin(), userData.end());
    const auto number = static_cast<std::int64_t>(++_announcements);
    FromVendor(Join(
        {Header(Name), RtpsBytes::Submessage(Data, DataBody(number, data, ParticipantWriter), HasData)}));
    // The card has the reader; the model announces writers alone.
    if (number == 1)
    {
        const Bytes reader = EndpointData(Name, BeatReader, BeatTopic, BeatType);
        FromVendor(Join({Header(Name), EndpointSaid(SubscriptionsWriter, reader, 1)}));
        FromVendor(Join({Header(Name), EndpointSaid(PublicationsWriter, WriterData(BeatWriter, Name), 1)}));
    }
}

void GuardedNode::Arrive(std::span<const std::uint8_t> datagram, const HostAddress &from, TimePoint now)
{
    _now = now;
    Bytes copy(datagram.begin(), datagram.end());
    if (IsCardMessage(copy))
    {
        _meeting.Received(copy, from, _guard.IsKnownAt(copy, from), now);
        return;
    }
    _guard.Admit(copy, from, now, [&](std::span<std::uint8_t> admitted) { Dds.Receive(admitted, now); });
    if (_guard.TakeReplyDue())
    {
        Announce();
    }
}

void GuardedNode::EndSilent()
{
    for (const GuidPrefix &peer : _meeting.Endable())
    {
        if (_now - _guard.LastHeard(peer).value_or(TimePoint{}) >= _meeting.EndAfter())
        {
            _meeting.End(peer);
        }
    }
}

void GuardedNode::Step(TimePoint now)
{
    _now = now;
    const bool isFirst = !_begun;
    const auto since = now - _begun.value_or(now);
    _begun = _begun.value_or(now);
    if (since % Period == since.zero())
    {
        Announce();
    }
    if (since % std::chrono::seconds(1) == since.zero())
    {
        Dds.Dds.Tick();
        EndSilent();
    }
    if (!isFirst && since % BeatPeriod == since.zero())
    {
        Send(Join(
            {Header(Name), RtpsBytes::Submessage(
                               Data, DataBody(++_beats, {0, 1, 0, 0, 7, 0, 0, 0}, BeatWriter), HasData)}));
    }
    if (since % SamplePeriod == since.zero())
    {
        for (const Rabit::Rtps::Place &place : Dds.Readers())
        {
            const bool goes =
                _guard.MayGo(place, SampleSize, Rabit::Rtps::Ledger::Cargo::Samples, _addresses, now);
            SentBytes += goes ? SampleSize + CardExchange::IpAndUdp : 0;
        }
    }
    while (_meeting.LocalDue() && *_meeting.LocalDue() <= now)
    {
        for (auto &local : _meeting.TakeLocal(now))
        {
            _guard.Admit(
                local.Bytes, local.From, now,
                [&](std::span<std::uint8_t> admitted) { Dds.Receive(admitted, now); },
                RtpsGuard::Origin::Card);
        }
    }
    while (_meeting.NetworkDue() && *_meeting.NetworkDue() <= now)
    {
        if (const auto outgoing = _meeting.TakeForNetwork(now))
        {
            Send(outgoing->Bytes);
        }
    }
}

bool GuardedNode::Knows(const GuardedNode &other) const
{
    return Dds.Dds.Knows(other.Name) && Dds.Dds.EndpointsOf(other.Name).contains(BeatWriter);
}

}  // namespace Opponent
