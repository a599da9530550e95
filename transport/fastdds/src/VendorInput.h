// Hands datagrams to the vendor: those that come from the network, and those that are made here.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "Introductions.h"
#include "Vendor.h"
#include "common/Rtps.h"

namespace Rabit::FastDds
{

// The vendor's receiver of the datagrams that come to one of its ports, with the addresses of the last one.
// The vendor owns `Next`. SessionCore stops all threads that use it before it removes the participant.
struct Receiver
{
    rtps::TransportReceiverInterface *Next = nullptr;
    rtps::Locator_t Local;
    rtps::Locator_t Remote;
};

// Knows the vendor's receivers by port, and which of them takes discovery data: the vendor has one receiver
// for each port, and its receivers of samples drop discovery data. Where the vendor awaits protected
// announcements, VendorInput hands it plain ones in their place (Introductions.h, AsProtected in Vendor.h).
//
// Thread-safe. `_mutex` guards the receivers and the own announcement, and is never held while something is
// called. `_protecting` is held while the vendor takes a message as a protected one, since AsProtected wants
// one thread at a time.
class VendorInput
{
public:
    // `groupPort`: the port of the multicast group of discovery; 0: none. `introduces`: the vendor awaits
    // protected announcements.
    VendorInput(std::uint32_t groupPort, bool introduces) : _groupPort(groupPort), _introduces(introduces) {}

    // Notes an announcement of the own participant. Called on the threads on which the vendor sends.
    void NoteOwn(std::span<const std::uint8_t> announcement);
    // The last announcement of the own participant; empty: there is none yet.
    std::vector<std::uint8_t> OwnAnnouncement() const;
    // The sender of OwnAnnouncement; GuidPrefix{}: there is none yet.
    Rtps::GuidPrefix OwnPrefix() const;

    // Notes a receiver that was given a datagram, before the vendor sees the datagram. Hands over the
    // goodbyes that waited for a receiver of discovery. Called on its receiving thread, without the vendor's
    // locks.
    void NoteReceiver(const Receiver &receiver);
    // Notes the port of a sound card message.
    void NoteCardPort(std::uint32_t port);

    // Returns a receiver for discovery data that is made here. Next is null until a datagram has come to a
    // port of discovery.
    Receiver DiscoveryReceiver() const;
    // Hands over a message that is no news of a participant. Does nothing if Next is null.
    static void HandOn(const Receiver &receiver, std::span<std::uint8_t> message);

    // Hands over a datagram that the guard has admitted. Called on receiving threads, without the vendor's
    // locks, as is Introduce.
    void Deliver(const Receiver &receiver, std::span<std::uint8_t> admitted);
    // Hands the announcement of a datagram's sender to the vendor once more, if the sender is authenticated.
    // The vendor has seen the datagram.
    void Introduce(std::span<const std::uint8_t> datagram);
    // Hands over the goodbye of a participant in its name. If there is no receiver of discovery yet, the
    // goodbye waits for one (NoteReceiver). Called on a thread without locks.
    void Forget(const Rtps::GuidPrefix &peer, std::span<std::uint8_t> goodbye);

private:
    void HandOnAsProtected(const Receiver &receiver, const Rtps::GuidPrefix &peer,
                           std::span<std::uint8_t> message);
    // As Forget, if there is a receiver.
    void HandOnGoodbye(const Receiver &receiver, const Rtps::GuidPrefix &peer,
                       std::span<std::uint8_t> goodbye);
    // DiscoveryReceiver. Requires _mutex.
    Receiver FindDiscoveryReceiver() const;
    // Hands over the last announcement of a participant, once, if there is a receiver.
    void HandOnAnnouncement(const Receiver &receiver, const Rtps::GuidPrefix &peer);

    const std::uint32_t _groupPort;
    const bool _introduces;
    Introductions _introductions;  // empty unless _introduces
    std::mutex _protecting;
    mutable std::mutex _mutex;                     // guards the members below
    std::map<std::uint32_t, Receiver> _receivers;  // by port
    // Goodbyes without a receiver of discovery, one for each participant.
    std::map<Rtps::GuidPrefix, std::vector<std::uint8_t>> _waiting;
    std::uint32_t _cardPort = 0;                 // of the last sound card message
    std::vector<std::uint8_t> _announcement;     // our last one
    std::vector<std::uint32_t> _discoveryPorts;  // that it names
};

}  // namespace Rabit::FastDds
