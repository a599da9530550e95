// Hands datagrams to the vendor: those that come from the network, and those that are made here.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "Vendor.h"

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
// for each port, and its receivers of samples drop discovery data. Thread-safe: the lock is never held while
// something is called.
class VendorInput
{
public:
    // `groupPort`: the port of the multicast group of discovery; 0: none.
    explicit VendorInput(std::uint32_t groupPort) : _groupPort(groupPort) {}

    // Notes an announcement of the own participant. Called on the threads on which the vendor sends.
    void NoteOwn(std::span<const std::uint8_t> announcement);
    // Notes a receiver that was given a datagram, before the vendor sees the datagram.
    void NoteReceiver(const Receiver &receiver);
    // Notes the port of a sound card message.
    void NoteCardPort(std::uint32_t port);

    // Returns a receiver for discovery data that is made here. Next is null until a datagram has come to a
    // port of discovery.
    Receiver DiscoveryReceiver() const;
    // Hands over a message. Does nothing if Next is null.
    static void HandOn(const Receiver &receiver, std::span<std::uint8_t> message);

private:
    const std::uint32_t _groupPort;
    mutable std::mutex _mutex;                     // guards the members below
    std::map<std::uint32_t, Receiver> _receivers;  // by port
    std::uint32_t _cardPort = 0;                   // of the last sound card message
    std::vector<std::uint32_t> _discoveryPorts;    // that our last announcement names
};

}  // namespace Rabit::FastDds
