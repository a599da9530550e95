// Gives datagrams to the vendor's sockets.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "GuardedUdp.h"
#include "ReplySocket.h"
#include "Vendor.h"
#include "common/HardwareAddresses.h"
#include "common/RecentNumbers.h"
#include "common/Rtps.h"
#include "guard/RtpsGuard.h"
#include "rtps/CardRoutes.h"

namespace Rabit::FastDds
{

// Knows which of the vendor's sockets sends to which destinations, and which routes lead to a participant.
// Sends samples to a group in place of hosts that the kernel cannot send to yet (HardwareAddresses).
//
// Not thread-safe: GuardedUdp calls all functions with one lock held, which is also taken to send what a turn
// has kept. Send alone lets go of it, to seal a datagram. They call the sockets, OnSent and the guard. The
// vendor owns the sockets. SessionCore stops all threads that use them before it removes the participant.
class SocketOutput
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Destinations = std::vector<rtps::Locator_t>;
    using Lock = std::unique_lock<std::mutex>;

    // The arguments must outlive the object. `udp`: the transport of the sockets. `sending`: the lock.
    SocketOutput(const GuardedUdpDescriptor::Settings &settings, Rtps::RtpsGuard &guard,
                 rtps::TransportInterface &udp, std::mutex &sending)
        : _settings(settings),
          _guard(guard),
          _udp(udp),
          _sending(sending),
          _cardRoutes(settings.AnnouncementPeriod)
    {
    }

    // Numbers of sockets, in the order of their first use here, and of routes. Equal numbers mean equal
    // routes.
    std::uint32_t NumberOf(rtps::SenderResource *socket);
    std::uint64_t NumberOf(const Route &route);
    // True if the socket of the route sends to a destination that it is given.
    bool Leaves(const Route &route);

    // Notes that the vendor sends to `peer` by that route.
    void NoteRoute(const Rtps::GuidPrefix &peer, const Route &route);
    // Notes that the vendor announces its participant by that route.
    void NoteAnnounced(const Route &route, TimePoint now);
    // `peer` has announced that it takes discovery data there (CardRoutes). For sessions whose samples do not
    // go to a group.
    void NoteHeard(const Rtps::GuidPrefix &peer, const Rtps::Place &at, TimePoint now)
    {
        _cardRoutes.NoteHeard(peer, at, now);
    }
    // Sends a card message to a participant, or to all if it is empty or not known. Unlocks `lock` to seal.
    void SendCard(const std::optional<Rtps::GuidPrefix> &peer, std::span<const std::uint8_t> datagram,
                  TimePoint now, const TimePoint &timeout, Lock &lock);

    // Replaces destinations of samples with unknown hardware addresses by the group. `toOne`: all
    // destinations are addresses of one participant, and one that works is enough.
    void ChooseGroupWhereAddressesLack(rtps::SenderResource *socket, bool toOne, TimePoint now,
                                       Destinations &destinations);
    // Number of datagrams that Send will send.
    std::size_t DatagramsTo(rtps::SenderResource *socket, const Destinations &destinations);
    // Sends to those of the destinations to which the socket sends and to which the datagram may go
    // (Ledger.h), and counts the datagrams (OnSent). `samples`: it has samples. In a turn of this thread,
    // such a datagram is kept for its end. Otherwise, if datagrams are sealed, it is sealed for each
    // destination, with `lock` unlocked meanwhile. Returns false if the socket fails.
    bool Send(rtps::SenderResource *socket, const Destinations &destinations,
              std::span<const std::uint8_t> datagram, bool samples, const TimePoint &timeout, Lock &lock);
    // Sends a sealed datagram to all as it is, and counts it: by the routes of card messages, and, where
    // samples do not go to a group, to SealedSession::Strangers. The sockets of nodes that send do not
    // receive, so it goes to the usual ports of a stranger's host, as far as strangers are sent something.
    void SendSealed(std::span<const std::uint8_t> sealed, TimePoint now, const TimePoint &timeout);
    // The most bytes that sealing adds to a datagram; 0: none is sealed.
    std::size_t MostAdded() const { return _settings.Seal != nullptr ? _settings.Seal->MostAdded() : 0; }

private:
    bool Leaves(std::uint32_t socket, const rtps::Locator_t &destination) const;
    std::uint32_t NumberOf(const rtps::Locator_t &destination);
    bool MayGo(const rtps::Locator_t &destination, std::size_t bytes, bool samples, TimePoint now);
    // Sends a datagram as it is to a place to which the vendor may send nothing.
    void SendTo(const Rtps::Place &to, std::span<const std::uint8_t> datagram, const TimePoint &timeout);
    // The places of SealedSession::Strangers.
    std::vector<Rtps::Place> PlacesOfStrangers(TimePoint now) const;
    // Seals for one destination. Returns false if the datagram must not go. Needs no lock.
    bool SealFor(const rtps::Locator_t &destination, std::span<const std::uint8_t> datagram,
                 std::vector<std::uint8_t> &sealed) const;
    bool SendOne(const Route &route, std::span<const std::uint8_t> datagram, const TimePoint &timeout);
    void Keep(const Route &route, std::span<const std::uint8_t> datagram);
    // Takes the lock.
    void SendKept(const Route &route, std::vector<std::uint8_t> &message);

    const GuardedUdpDescriptor::Settings &_settings;
    Rtps::RtpsGuard &_guard;
    rtps::TransportInterface &_udp;
    std::mutex &_sending;
    HardwareAddresses _addresses;
    Rtps::CardRoutes<Route> _cardRoutes;
    RecentNumbers<rtps::Locator_t> _destinations;
    std::map<rtps::SenderResource *, std::uint32_t> _sockets;
    rtps::SendResourceList _noSockets;
    ReplySocket _reply;
    Destinations _allowed;  // of the datagram to send
};

}  // namespace Rabit::FastDds
