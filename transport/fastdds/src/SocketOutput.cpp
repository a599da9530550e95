#include "SocketOutput.h"

#include <algorithm>
#include <memory>

#include "common/RtpsWriter.h"
#include "envelope/MergedDatagram.h"
#include "guard/RtpsMessage.h"
#include "rtps/CardMessage.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace
{

// A socket that does not block takes no time.
constexpr std::chrono::milliseconds KeptTimeout{100};

}  // namespace

std::uint32_t SocketOutput::NumberOf(rtps::SenderResource *socket)
{
    return _sockets.emplace(socket, static_cast<std::uint32_t>(_sockets.size())).first->second;
}

// The vendor's sockets know only the destinations that a writer names when it matches. If the writer later
// uses another one, an assertion ends the process: the reader's own address, for instance, where several
// share a group.
std::uint32_t SocketOutput::NumberOf(const rtps::Locator_t &destination)
{
    const auto [number, isNew] = _destinations.Of(destination);
    if (isNew)
    {
        // Opens no socket: one exists already, and is about to send.
        _udp.OpenOutputChannel(_noSockets, destination);
    }
    return static_cast<std::uint32_t>(number);
}

std::uint64_t SocketOutput::NumberOf(const Route &route)
{
    const std::uint64_t socket = NumberOf(route.first);
    return socket << 32 | NumberOf(route.second);
}

bool SocketOutput::Leaves(std::uint32_t socket, const rtps::Locator_t &destination) const
{
    return _settings.SocketsSendAll || IsGroup(destination) != (socket == 0);
}

bool SocketOutput::Leaves(const Route &route)
{
    return Leaves(NumberOf(route.first), route.second);
}

void SocketOutput::NoteRoute(const GuidPrefix &peer, const Route &route)
{
    NumberOf(route.second);
    _cardRoutes.Note(peer, route);
}

void SocketOutput::NoteAnnounced(const Route &route, TimePoint now)
{
    _cardRoutes.NoteForAll(route, IsGroup(route.second), now);
}

void SocketOutput::SendCard(const std::optional<GuidPrefix> &peer, std::span<const std::uint8_t> datagram,
                            TimePoint now, const TimePoint &timeout, Lock &lock)
{
    const std::vector<Place> places = _cardRoutes.HeardAt(peer, now);
    // A participant that was heard is no listed peer without a route: nothing needs to go to all.
    const std::vector<Route> routes =
        peer && !places.empty() ? std::vector<Route>() : _cardRoutes.To(peer, now);
    for (const auto &[socket, destination] : routes)
    {
        Send(socket, {destination}, datagram, false, timeout, lock);
    }
    for (const Place &place : places)
    {
        const bool isSent =
            std::any_of(routes.begin(), routes.end(),
                        [&place](const Route &route) { return PlaceOf(route.second) == place; });
        if (isSent || !_guard.MayGo(place, datagram.size(), Ledger::Cargo::Discovery, _addresses, now))
        {
            continue;
        }
        if (_settings.Seal == nullptr)
        {
            SendTo(place, datagram, timeout);
            continue;
        }
        thread_local std::vector<std::uint8_t> sealed;
        lock.unlock();
        const bool isSealed = SealFor(LocatorOf(place), datagram, sealed);
        lock.lock();
        if (isSealed)
        {
            SendTo(place, sealed, timeout);
        }
    }
}

void SocketOutput::ChooseGroupWhereAddressesLack(rtps::SenderResource *socket, bool toOne, TimePoint now,
                                                 Destinations &destinations)
{
    const auto isAwaited = [this, now](const rtps::Locator_t &destination)
    { return !IsGroup(destination) && _addresses.IsAwaited(HostOf(destination), now); };
    if (_settings.Meeting == nullptr || !_settings.SampleGroup ||
        (toOne && !std::all_of(destinations.begin(), destinations.end(), isAwaited)))
    {
        return;
    }
    const std::uint32_t number = NumberOf(socket);
    bool lacks = false;
    std::erase_if(destinations,
                  [&](const rtps::Locator_t &destination)
                  {
                      const HostAddress host = HostOf(destination);
                      const bool byGroup = isAwaited(destination) &&
                                           _guard.GroupReaches(host, now - HardwareAddresses::InReach);
                      lacks = lacks || byGroup;
                      return byGroup && Leaves(number, destination) && !_addresses.HasToAsk(host, now);
                  });
    if (lacks && std::none_of(destinations.begin(), destinations.end(), IsGroup))
    {
        destinations.push_back(*_settings.SampleGroup);
        NumberOf(destinations.back());
    }
}

std::size_t SocketOutput::DatagramsTo(rtps::SenderResource *socket, const Destinations &destinations)
{
    const std::uint32_t number = NumberOf(socket);
    return static_cast<std::size_t>(std::count_if(destinations.begin(), destinations.end(),
                                                  [&](const rtps::Locator_t &destination)
                                                  { return Leaves(number, destination); }));
}

bool SocketOutput::MayGo(const rtps::Locator_t &destination, std::size_t bytes, bool samples, TimePoint now)
{
    const auto cargo = samples ? Ledger::Cargo::Samples : Ledger::Cargo::Discovery;
    return IsGroup(destination) || _guard.MayGo(PlaceOf(destination), bytes, cargo, _addresses, now);
}

bool SocketOutput::Send(rtps::SenderResource *socket, const Destinations &destinations,
                        std::span<const std::uint8_t> datagram, bool samples, const TimePoint &timeout,
                        Lock &lock)
{
    const std::uint32_t number = NumberOf(socket);
    const auto now = std::chrono::steady_clock::now();
    _allowed.clear();
    for (const rtps::Locator_t &destination : destinations)
    {
        if (Leaves(number, destination) && MayGo(destination, datagram.size(), samples, now))
        {
            _allowed.push_back(destination);
        }
    }
    if (samples && _settings.Sending->IsOfThisThread())
    {
        for (const rtps::Locator_t &destination : _allowed)
        {
            Keep({socket, destination}, datagram);
        }
        return true;
    }
    if (_settings.Seal == nullptr)
    {
        _settings.OnSent(samples, _allowed.size(), _allowed.size() * datagram.size());
        rtps::Locators first(_allowed.cbegin());
        rtps::Locators last(_allowed.cend());
        return ChainedUdp::SendOn(*socket, datagram, first, last, timeout);
    }
    thread_local std::vector<std::uint8_t> sealed;
    bool isSent = true;
    for (const rtps::Locator_t &destination : Destinations(_allowed))
    {
        lock.unlock();
        const bool isSealed = SealFor(destination, datagram, sealed);
        lock.lock();
        if (isSealed)
        {
            _settings.OnSent(samples, 1, sealed.size());
            isSent = SendOne({socket, destination}, sealed, timeout) && isSent;
        }
    }
    return isSent;
}

bool SocketOutput::SealFor(const rtps::Locator_t &destination, std::span<const std::uint8_t> datagram,
                           std::vector<std::uint8_t> &sealed) const
{
    const auto place = IsGroup(destination) ? std::nullopt : std::optional(PlaceOf(destination));
    const bool isCard = IsCardMessage(datagram);
    const auto contents = isCard ? Envelope::OuterClass::Meeting : Envelope::OuterClass::Traffic;
    // The build of the vendor decides on the minor version, 2 or 3, and does not tell before it sends.
    constexpr std::size_t minorVersionAt = 5;
    thread_local std::vector<std::uint8_t> copy;
    if (!isCard && datagram.size() > minorVersionAt &&
        datagram[minorVersionAt] != _settings.Header[minorVersionAt])
    {
        copy.assign(datagram.begin(), datagram.end());
        copy[minorVersionAt] = _settings.Header[minorVersionAt];
        datagram = copy;
    }
    return _settings.Seal->Seal(datagram, place, contents, sealed);
}

void SocketOutput::SendSealed(std::span<const std::uint8_t> sealed, TimePoint now, const TimePoint &timeout)
{
    const std::vector<Route> routes = _cardRoutes.To(std::nullopt, now);
    for (const Route &route : routes)
    {
        _settings.OnSent(false, 1, sealed.size());
        SendOne(route, sealed, timeout);
    }
    for (const Place &place : PlacesOfStrangers(now))
    {
        const bool isSent =
            std::any_of(routes.begin(), routes.end(),
                        [&place](const Route &route) { return PlaceOf(route.second) == place; });
        if (!isSent && _guard.MayGo(place, sealed.size(), Ledger::Cargo::Discovery, _addresses, now))
        {
            SendTo(place, sealed, timeout);
        }
    }
}

std::vector<Place> SocketOutput::PlacesOfStrangers(TimePoint now) const
{
    std::vector<Place> places;
    if (_settings.SampleGroup)
    {
        return places;
    }
    for (const Place &stranger : _settings.Seal->Strangers(now))
    {
        if (stranger.Port != 0)
        {
            places.push_back(stranger);
            continue;
        }
        for (const std::uint16_t port : _settings.DiscoveryPorts)
        {
            places.push_back({.Host = stranger.Host, .Port = port});
        }
    }
    return places;
}

void SocketOutput::SendTo(const Place &to, std::span<const std::uint8_t> datagram, const TimePoint &timeout)
{
    if (_sockets.empty())
    {
        _settings.OnSent(false, 1, datagram.size());
        _reply.Send(to, datagram);
        return;
    }
    const rtps::Locator_t destination = LocatorOf(to);
    NumberOf(destination);
    for (const auto &[socket, number] : _sockets)
    {
        if (Leaves(number, destination))
        {
            _settings.OnSent(false, 1, datagram.size());
            SendOne({socket, destination}, datagram, timeout);
        }
    }
}

bool SocketOutput::SendOne(const Route &route, std::span<const std::uint8_t> datagram,
                           const TimePoint &timeout)
{
    _allowed.assign(1, route.second);
    rtps::Locators first(_allowed.cbegin());
    rtps::Locators last(_allowed.cend());
    return ChainedUdp::SendOn(*route.first, datagram, first, last, timeout);
}

void SocketOutput::Keep(const Route &route, std::span<const std::uint8_t> datagram)
{
    const auto make = [this, &route](std::size_t most)
    {
        return std::make_unique<MergedDatagram>(most - std::min(most, MostAdded()),
                                                [this, route](std::vector<std::uint8_t> &message)
                                                { SendKept(route, message); });
    };
    const auto grown = _settings.Sending->Take({NumberOf(route), 0}, datagram, make);
    _settings.OnSent(true, grown.Datagrams, grown.Bytes);
}

void SocketOutput::SendKept(const Route &route, std::vector<std::uint8_t> &message)
{
    const auto timeout = std::chrono::steady_clock::now() + KeptTimeout;
    if (_settings.Seal != nullptr)
    {
        thread_local std::vector<std::uint8_t> sealed;
        if (SealFor(route.second, message, sealed))
        {
            const Lock lock(_sending);
            _settings.OnSent(true, 0, sealed.size() - message.size());
            SendOne(route, sealed, timeout);
        }
        return;
    }
    // The last parts of a merged message may end like statistics together.
    while (EndsLikeStatistics(message) && SizeWithoutStatistics(message) == message.size())
    {
        AppendSubmessageHeader(message, SubmessageKind::Pad, 0);
    }
    const Lock lock(_sending);
    SendOne(route, message, timeout);
}

}  // namespace Rabit::FastDds
