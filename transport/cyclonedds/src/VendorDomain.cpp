#include "VendorDomain.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "AnnouncedEndpoints.h"
#include "DomainConfig.h"
#include "Guid.h"
#include "Places.h"
#include "SampleBurst.h"
#include "VendorLog.h"
#include "VendorTraffic.h"
#include "common/HeldDatagrams.h"
#include "common/MulticastUse.h"
#include "common/RtpsTraffic.h"
#include "envelope/JoinMessages.h"
#include "envelope/MergedDatagram.h"
#include "envelope/SessionPlaces.h"

namespace Rabit::Cyclone
{

namespace
{

// Numbers from here on are of no domain of the network.
constexpr dds_domainid_t FirstOther = 1000;
// A host that is not listed is answered at the ports of this many participants.
constexpr int PortsOfStranger = 4;
// A byte to the own address wakes the vendor's receiving thread. It is sent again, since it may be lost.
constexpr std::chrono::milliseconds WakeAgain{100};
constexpr std::chrono::seconds LongestWake{10};

bool IsSame(const RabitCyclonePlace &one, const RabitCyclonePlace &other)
{
    return std::to_array(one.address) == std::to_array(other.address) && one.port == other.port;
}

SendingTurn::Way WayOf(const RabitCycloneRoute &route, RabitCycloneTo to)
{
    std::uint64_t place = 0;
    for (const unsigned char byte : route.address)
    {
        place = place << 8 | byte;
    }
    // All datagrams from a socket to the group of samples go one way.
    return {reinterpret_cast<std::uintptr_t>(route.connection),
            to == RabitCycloneToSampleGroup ? 0 : place << 16 | route.port};
}

bool IsGroup(const DirectAnnouncements::Address &address)
{
    return (address[0] & 0xf0) == 0xe0;
}

}  // namespace

void VendorDomain::SendCard(const std::optional<Rtps::GuidPrefix> &to, std::span<const std::uint8_t> datagram)
{
    std::vector<RabitCycloneRoute> routes;
    std::vector<Rtps::Place> places;
    {
        const auto now = std::chrono::steady_clock::now();
        const std::lock_guard lock(_cardMutex);
        places = _cardRoutes.HeardAt(to, now);
        // A participant that was heard is no listed peer without a route: nothing needs to go to all.
        if (!to || places.empty())
        {
            routes = _cardRoutes.To(to, now);
        }
    }
    for (const Rtps::Place &heard : places)
    {
        const RabitCyclonePlace place = ToCyclonePlace(heard);
        const bool isSent =
            std::any_of(routes.begin(), routes.end(),
                        [&place](const RabitCycloneRoute &route) { return IsSame(EndOf(route), place); });
        if (!isSent && MayGo(this, &place, datagram.size(), false))
        {
            routes.push_back(RabitCycloneRouteTo(_watch, &place));
        }
    }
    for (const RabitCycloneRoute &route : routes)
    {
        Send(route, RabitCycloneToHost, datagram);
    }
}

void VendorDomain::NoteHeard(std::span<const std::uint8_t> datagram, const Rtps::HostAddress &host)
{
    if (!_meets || _multicast || !AnnouncingOf(datagram).Any)
    {
        return;
    }
    const auto announced = Envelope::ReadAnnouncedPlaces(datagram);
    const auto at = announced.HasCard ? announced.DiscoveryAt(host) : std::nullopt;
    if (at && !_meeting.IsSelf(Rtps::SenderOf(datagram)))
    {
        const std::lock_guard lock(_cardMutex);
        _cardRoutes.NoteHeard(Rtps::SenderOf(datagram), *at, std::chrono::steady_clock::now());
    }
}

void VendorDomain::Send(const RabitCycloneRoute &route, RabitCycloneTo to,
                        std::span<const std::uint8_t> datagram)
{
    const std::size_t sent = RabitCycloneSend(_watch, &route, to, datagram.data(), datagram.size());
    if (sent > 0)
    {
        OnSent(this, datagram.data(), datagram.size(), sent);
    }
}

std::vector<RabitCycloneRoute> VendorDomain::WaysOfSealed()
{
    std::vector<RabitCycloneRoute> routes;
    RabitCycloneAnnouncedRoutes(
        _watch,
        [](const RabitCycloneRoute *route, void *argument)
        { static_cast<std::vector<RabitCycloneRoute> *>(argument)->push_back(*route); },
        &routes);
    // As MaySend.
    std::erase_if(routes,
                  [this](const RabitCycloneRoute &route)
                  {
                      const auto address = std::to_array(route.address);
                      return _multicast && !IsGroup(address) && !_direct.MayGo(address);
                  });
    if (_multicast)
    {
        return routes;
    }
    for (const Rtps::Place &stranger : _seal->Session().Strangers(std::chrono::steady_clock::now()))
    {
        const auto ports = stranger.Port != 0 ? std::vector<std::uint16_t>{stranger.Port} : _usualPorts;
        for (const std::uint16_t port : ports)
        {
            const RabitCyclonePlace place = ToCyclonePlace({.Host = stranger.Host, .Port = port});
            if (std::none_of(routes.begin(), routes.end(),
                             [&place](const RabitCycloneRoute &route)
                             { return IsSame(EndOf(route), place); }))
            {
                routes.push_back(RabitCycloneRouteTo(_watch, &place));
            }
        }
    }
    return routes;
}

void VendorDomain::SendSealed(std::span<const std::uint8_t> sealed)
{
    for (const RabitCycloneRoute &route : WaysOfSealed())
    {
        const RabitCyclonePlace end = EndOf(route);
        if (MayGo(this, &end, sealed.size(), false) &&
            RabitCycloneSendSealed(_watch, &route, sealed.data(), sealed.size()))
        {
            _log->SentDiscovery(1, sealed.size());
        }
    }
}

// The vendor accepts datagrams on its receiving thread alone.
void VendorDomain::DeliverCard(const Rtps::HostAddress &from, std::span<std::uint8_t> datagram)
{
    const auto handOn = [this](std::span<std::uint8_t> admitted)
    {
        const std::lock_guard lock(_cardMutex);
        _delivered.emplace_back(admitted.begin(), admitted.end());
    };
    if (!_guard.Admit(datagram, from, std::chrono::steady_clock::now(), std::cref(handOn),
                      Rtps::RtpsGuard::Origin::Card))
    {
        _log->MalformedDatagram();
    }
    RabitCycloneWake(_watch);
}

std::size_t VendorDomain::JoinDelivered(std::span<std::uint8_t> buffer, std::size_t size)
{
    std::vector<std::vector<std::uint8_t>> now;
    bool isMore = false;
    {
        const std::lock_guard lock(_cardMutex);
        std::size_t room = (buffer.size() - size) / 2;
        auto at = _delivered.begin();
        while (at != _delivered.end() && at->size() <= room)
        {
            room -= at->size();
            ++at;
        }
        now.assign(std::make_move_iterator(_delivered.begin()), std::make_move_iterator(at));
        _delivered.erase(_delivered.begin(), at);
        isMore = !_delivered.empty();
    }
    if (isMore)
    {
        RabitCycloneWake(_watch);
    }
    return Rtps::JoinMessages(now, buffer, size);
}

void VendorDomain::Came(const Rtps::GuidPrefix &participant)
{
    std::vector<RabitCyclonePlace> places;
    const ddsi_guid_t guid = ParticipantOf(participant);
    RabitCyclonePeerAddresses(
        &guid,
        [](const RabitCyclonePlace *place, void *argument)
        { static_cast<std::vector<RabitCyclonePlace> *>(argument)->push_back(*place); },
        &places);
    const std::lock_guard lock(_cardMutex);
    _reached.insert_or_assign(participant, std::move(places));
}

// The vendor announces its participant at each address at which it has ever heard another one.
void VendorDomain::Gone(const Rtps::GuidPrefix &participant)
{
    std::vector<RabitCyclonePlace> left;
    {
        const std::lock_guard lock(_cardMutex);
        const auto found = _reached.find(participant);
        if (found == _reached.end())
        {
            return;
        }
        left = std::move(found->second);
        _reached.erase(found);
        for (const auto &other : _reached)
        {
            const auto isThere = [&other](const RabitCyclonePlace &place)
            {
                return std::any_of(other.second.begin(), other.second.end(),
                                   [&](const RabitCyclonePlace &each) { return IsSame(each, place); });
            };
            std::erase_if(left, isThere);
        }
    }
    for (const RabitCyclonePlace &place : left)
    {
        RabitCycloneAnnounceNoMoreTo(_watch, &place);
    }
}

void VendorDomain::Lost(const Rtps::GuidPrefix &participant)
{
    if (_meets)
    {
        _meeting.Lost(participant);
    }
}

bool VendorDomain::MaySend(void *self, unsigned char *datagram, std::size_t size,
                           const RabitCycloneRoute *route)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    const Announcing announcing = AnnouncingOf({datagram, size});
    if (announcing.Any)
    {
        LeaveOutIdleEndpoints({datagram, size});
    }
    if (domain._meets && domain._meeting.Sending({datagram, size}))
    {
        const std::lock_guard lock(domain._cardMutex);
        domain._cardRoutes.Note(DestinationOf({datagram, size}), *route);
        return false;
    }
    const DirectAnnouncements::Address address{route->address[0], route->address[1], route->address[2],
                                               route->address[3]};
    const bool direct = domain._direct.MayGo(address);
    if (announcing.Alone && domain._multicast && !IsGroup(address) && !direct)
    {
        return false;
    }
    if (announcing.Any && (IsGroup(address) || domain._hasPeers))
    {
        const std::lock_guard lock(domain._cardMutex);
        domain._cardRoutes.NoteForAll(*route, IsGroup(address), std::chrono::steady_clock::now());
    }
    return true;
}

// The writer, which owns the held datagrams, is destroyed before the domain.
bool VendorDomain::Hold(void *self, const unsigned char *datagram, std::size_t size,
                        const RabitCycloneRoute *route)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    HeldDatagrams::Scope *const held = HeldDatagrams::OfThisThread();
    return held != nullptr &&
           held->Keep(
               HeldDatagrams::IpAndUdp + size + (domain._seal != nullptr ? domain._seal->MostAdded() : 0),
               [&domain, to = *route, bytes = std::vector<std::uint8_t>(datagram, datagram + size)]
               {
                   const RabitCyclonePlace place = EndOf(to);
                   if (!MayGo(&domain, &place, bytes.size(), true))
                   {
                       return;
                   }
                   const auto send = [&domain, &to, &bytes](RabitCycloneTo where)
                   {
                       domain._sending->IsOfThisThread()
                           ? Take(&domain, bytes.data(), bytes.size(), &to, where)
                           : domain.Send(to, where, bytes);
                   };
                   const RabitCycloneWays ways = WaysTo(&domain, to.address);
                   if (ways.group)
                   {
                       send(RabitCycloneToSampleGroup);
                   }
                   if (ways.host)
                   {
                       send(RabitCycloneToHost);
                   }
               });
}

bool VendorDomain::IsInTurn(void *self)
{
    return static_cast<VendorDomain *>(self)->_sending->IsOfThisThread();
}

void VendorDomain::Take(void *self, const unsigned char *datagram, std::size_t size,
                        const RabitCycloneRoute *route, RabitCycloneTo to)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    const auto make = [&domain, route, to](std::size_t most)
    {
        return std::make_unique<Rtps::MergedDatagram>(
            domain.Unsealed(most),
            [&domain, way = *route, to](std::vector<std::uint8_t> &message)
            {
                // The message itself is counted below.
                const std::size_t sent =
                    RabitCycloneSend(domain._watch, &way, to, message.data(), message.size());
                domain._log->SentSamples(0, sent - std::min(sent, message.size()));
            });
    };
    const auto grown = domain._sending->Take(WayOf(*route, to), {datagram, size}, make);
    domain._log->SentSamples(grown.Datagrams, grown.Bytes);
}

RabitCycloneWays VendorDomain::WaysTo(void *self, const unsigned char *address)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    const auto now = std::chrono::steady_clock::now();
    Rtps::HostAddress host{};
    std::copy_n(address, host.size(), host.begin());
    const bool isAwaited = domain._meets && domain._multicast && domain._addresses.IsAwaited(host, now) &&
                           domain._guard.GroupReaches(host, now - HardwareAddresses::InReach);
    return {.host = !isAwaited || domain._addresses.HasToAsk(host, now), .group = isAwaited};
}

bool VendorDomain::MayGo(void *self, const RabitCyclonePlace *place, std::size_t size, bool samples)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    const Rtps::Place to = ToPlace(*place);
    return IsGroup(to.Host) ||
           domain._guard.MayGo(to, size,
                               samples ? Rtps::Ledger::Cargo::Samples : Rtps::Ledger::Cargo::Discovery,
                               domain._addresses, std::chrono::steady_clock::now());
}

RabitCycloneSealed VendorDomain::Seal(void *self, const ddsrt_iovec_t *part, std::size_t parts,
                                      const RabitCyclonePlace *to)
{
    return static_cast<VendorDomain *>(self)->_seal->Seal({part, parts}, to);
}

void VendorDomain::OnSent(void *self, const unsigned char *head, std::size_t headSize, std::size_t size)
{
    const auto &domain = *static_cast<const VendorDomain *>(self);
    if (!IsOfSamples({head, headSize}))
    {
        domain._log->SentDiscovery(1, size);
        return;
    }
    domain._log->SentSamples(1, size);
    if (domain._seal != nullptr)
    {
        thread_local SampleBurst burst;
        if (const auto pause = burst.Sent(size, std::chrono::steady_clock::now()); pause.count() > 0)
        {
            std::this_thread::sleep_for(pause);
        }
    }
}

std::size_t VendorDomain::Admit(std::span<std::uint8_t> buffer, std::size_t size,
                                const Rtps::HostAddress &from)
{
    std::vector<std::vector<std::uint8_t>> others;
    std::size_t left = 0;
    const auto handOn = [&](std::span<std::uint8_t> admitted)
    {
        if (admitted.data() == buffer.data())
        {
            left = admitted.size();
        }
        else
        {
            others.emplace_back(admitted.begin(), admitted.end());
        }
    };
    if (!_guard.Admit(buffer.first(size), from, std::chrono::steady_clock::now(), std::cref(handOn)))
    {
        _log->MalformedDatagram();
    }
    return Rtps::JoinMessages(others, buffer, left);
}

std::size_t VendorDomain::OnReceived(void *self, unsigned char *datagram, std::size_t size,
                                     std::size_t capacity, const RabitCyclonePlace *from, bool direct)
{
    auto &domain = *static_cast<VendorDomain *>(self);
    if (domain._isDeaf)
    {
        const std::lock_guard lock(domain._deafMutex);
        domain._readWhileDeaf = true;
        domain._hasRead.notify_all();
        return 0;
    }
    const Rtps::Place source = from != nullptr ? ToPlace(*from) : Rtps::Place{};
    const Rtps::HostAddress &host = source.Host;
    if (domain._seal != nullptr)
    {
        size = domain._seal->Open({datagram, size}, source);
        if (size == 0)
        {
            return domain.JoinDelivered({datagram, capacity}, 0);
        }
    }
    domain.NoteHeard({datagram, size}, host);
    if (domain._meets && Rtps::IsCardMessage({datagram, size}))
    {
        if (!domain._meeting.Received({datagram, size}, host,
                                      domain._guard.IsKnownAt({datagram, size}, host)))
        {
            domain._log->MalformedDatagram();
        }
        return domain.JoinDelivered({datagram, capacity}, 0);
    }
    const std::size_t alone = domain.Admit({datagram, capacity}, size, host);
    const std::size_t admitted = domain._meets && !IsOfSamples({datagram, alone})
                                     ? domain.JoinDelivered({datagram, capacity}, alone)
                                     : alone;
    if (IsOfSamples({datagram, admitted}))
    {
        return admitted;
    }
    const Announcing announcing = AnnouncingOf({datagram, admitted});
    if (announcing.Alone && direct && from != nullptr)
    {
        domain._direct.OnAnnouncement(host);
    }
    if (announcing.Any)
    {
        LeaveOutIdleEndpoints({datagram, admitted});
    }
    return admitted;
}

VendorDomain::VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log,
                           const std::shared_ptr<DiscoveryTurns> &turns, std::shared_ptr<SendingTurn> sending,
                           std::shared_ptr<Rtps::RecentGoodbyes> goodbyes,
                           std::shared_ptr<Rtps::Ledger> accounts)
    : _id(static_cast<dds_domainid_t>(settings.Domain), FirstOther),
      _log(log),
      _sending(std::move(sending)),
      _multicast(IsMulticastForData(settings)),
      _hasPeers(!settings.Peers.empty()),
      _meeting({.Period = settings.AnnouncementPeriod,
                .Memory = _multicast ? settings.Memory : settings.Lease,
                .IsMulticast = _multicast},
               turns),
      _cardRoutes(settings.AnnouncementPeriod),
      _usualPorts(UsualDiscoveryPorts(settings.Domain, PortsOfStranger)),
      // The vendor itself checks which fragments it has sent.
      _guard(GuardMode(settings), settings.AnnouncementPeriod, Rtps::RtpsGuard::Vendor::CycloneDds,
             std::move(goodbyes), std::move(accounts)),
      _seal(MakeSeal(settings, turns))
{
    _meets = GuardMode(settings) == Rtps::RtpsGuard::Mode::Full;
    // The thread is made before the vendor calls this object: if it cannot be, nothing is to be undone.
    if (_meets)
    {
        _meeting.Prepare();
        _guard.SetObserver(_meeting);
    }
    if (_seal != nullptr)
    {
        const Envelope::SealedSession &session = _seal->Session();
        _guard.SetAuthority(
            {.May = [&session](const Rtps::GuidPrefix &peer, bool write, std::string_view topic)
             { return write ? session.MayWrite(peer, topic) : session.MayRead(peer, topic); },
             .NameOf = [&session](const Rtps::GuidPrefix &peer) { return session.NameOf(peer); }});
    }
    _isDeaf = _seal != nullptr;
    const std::string config = MakeDomainConfig(settings, _seal != nullptr ? _seal->MostAdded() : 0);
    VendorLog::Follow(Id(), log);
    dds_entity_t entity = 0;
    std::string said;
    {
        const VendorLogCapture capture;
        entity = dds_create_domain(Id(), config.c_str());
        said = capture.FirstLine();
    }
    if (entity < 0)
    {
        VendorLog::Leave(Id());
        const std::string why = said.empty() ? dds_strretcode(entity) : said;
        if (!settings.BackendConfig.empty())
        {
            throw TransportError(
                "Cyclone DDS does not accept the configuration " + settings.BackendConfig + ": " + why,
                "backend_config");
        }
        throw TransportError("Cyclone DDS cannot join domain " + std::to_string(settings.Domain) + ": " +
                             why);
    }
    if (!said.empty())
    {
        log->Line("Cyclone DDS: " + said);
    }
    _entity = Entity(entity, "");
    _watch = RabitCycloneWatch({.argument = this,
                                .isDiscovery =
                                    [](const unsigned char *head, std::size_t size) {
                                        return !IsOfSamples({head, size});
                                    },
                                .may = &MaySend,
                                .holds = [] { return HeldDatagrams::OfThisThread() != nullptr; },
                                .hold = &Hold,
                                .takes = &IsInTurn,
                                .take = &Take,
                                .waysTo = &WaysTo,
                                .mayGo = &MayGo,
                                .seal = _seal != nullptr ? &Seal : nullptr,
                                .sent = &OnSent,
                                .received = &OnReceived});
    CheckSecurity(settings);
    CheckSeal(settings);
    _meets = _meets && _watch != nullptr;
    if (_meets)
    {
        _meeting.Start({.Send = [this](const auto &to, auto datagram) { SendCard(to, datagram); },
                        .Deliver = [this](const auto &from, auto datagram) { DeliverCard(from, datagram); },
                        .LastHeard = [this](const auto &peer) { return _guard.LastHeard(peer); }});
    }
    if (_watch == nullptr)
    {
        log->Line(
            "Cyclone DDS does not show what it sends and gets: it is not counted, it is not announced more "
            "often, "
            "and nothing is kept from it");
    }
}

std::unique_ptr<SealedTraffic> VendorDomain::MakeSeal(const TransportSettings &settings,
                                                      const std::shared_ptr<DiscoveryTurns> &turns)
{
    if (settings.Member == nullptr)
    {
        return nullptr;
    }
    CheckSealable(settings);
    return std::make_unique<SealedTraffic>(
        settings.Member, turns,
        Envelope::SealedSession::Calls{
            .Send = [this](const auto & /*to*/, auto sealed) { SendSealed(sealed); },
            .Log = [log = _log](const std::string &line) { log->Line(line); }});
}

void VendorDomain::End()
{
    _entity.Reset();
    RabitCycloneUnwatch(_watch);
    VendorLog::Leave(Id());
}

void VendorDomain::CheckSecurity(const TransportSettings &settings)
{
    // The guard lets nothing of it pass: the node would hear nobody.
    if (_watch != nullptr && RabitCycloneHasSecurity(_watch))
    {
        End();
        throw TransportError("the Cyclone DDS configuration " + settings.BackendConfig +
                                 " has Security, which nodes do not use: leave it out, and give the nodes "
                                 "keys (rabit keys)",
                             "backend_config");
    }
}

void VendorDomain::CheckSeal(const TransportSettings &settings)
{
    if (_seal == nullptr)
    {
        return;
    }
    const char *const why =
        _watch == nullptr ? "its sockets cannot be watched" : RabitCyclonePassesBy(_watch);
    const bool hears = why == nullptr && Hear();
    if (hears)
    {
        return;
    }
    End();
    if (why == nullptr)
    {
        throw TransportError("Cyclone DDS cannot join domain " + std::to_string(settings.Domain) +
                             ": its receiving thread does not answer");
    }
    throw TransportError("the keys cannot protect all datagrams with the configuration " +
                             settings.BackendConfig + " of Cyclone DDS: " + why,
                         "backend_config");
}

bool VendorDomain::Hear()
{
    const auto end = std::chrono::steady_clock::now() + LongestWake;
    bool hasRead = false;
    std::unique_lock lock(_deafMutex);
    // The thread may have told of a read before the last socket was watched.
    _readWhileDeaf = false;
    while (!hasRead && std::chrono::steady_clock::now() < end)
    {
        lock.unlock();
        RabitCycloneWake(_watch);
        lock.lock();
        hasRead = _hasRead.wait_for(lock, WakeAgain, [this] { return _readWhileDeaf; });
    }
    lock.unlock();
    if (!hasRead || dds_domain_set_deafmute(_entity.Get(), false, false, DDS_INFINITY) != DDS_RETCODE_OK)
    {
        return false;
    }
    _isDeaf = false;
    return true;
}

void VendorDomain::Begin(const Rtps::GuidPrefix &own)
{
    if (_seal != nullptr)
    {
        _seal->Begin(own);
    }
    if (_meets)
    {
        _meeting.SetSelf(own);
    }
}

void VendorDomain::Announce(const ddsi_guid_t &participant) const
{
    if (_watch != nullptr)
    {
        RabitCycloneAnnounce(_watch, &participant);
    }
}

bool VendorDomain::IsUnheard(const ddsi_guid_t &participant) const
{
    return _watch != nullptr && RabitCycloneIsUnheard(_watch, &participant);
}

VendorDomain::~VendorDomain()
{
    _meeting.Stop();
    if (_seal != nullptr)
    {
        _seal->Stop();
    }
    _entity.Reset();
    RabitCycloneUnwatch(_watch);
    VendorLog::Leave(Id());
}

}  // namespace Rabit::Cyclone
