#include "VendorInput.h"

#include <utility>

#include "KeyAddressees.h"
#include "OutgoingMessage.h"
#include "guard/RtpsMessage.h"

namespace Rabit::FastDds
{

using namespace Rtps;

void VendorInput::NoteOwn(std::span<const std::uint8_t> announcement)
{
    auto ports = DiscoveryPortsOf(announcement);
    const std::lock_guard lock(_mutex);
    _announcement.assign(announcement.begin(), announcement.end());
    _discoveryPorts = std::move(ports);
}

std::vector<std::uint8_t> VendorInput::OwnAnnouncement() const
{
    const std::lock_guard lock(_mutex);
    return _announcement;
}

GuidPrefix VendorInput::OwnPrefix() const
{
    const std::lock_guard lock(_mutex);
    return _announcement.empty() ? GuidPrefix{} : SenderOf(_announcement);
}

void VendorInput::NoteReceiver(const Receiver &receiver)
{
    Receiver discovery;
    std::map<GuidPrefix, std::vector<std::uint8_t>> goodbyes;
    {
        const std::lock_guard lock(_mutex);
        _receivers.insert_or_assign(receiver.Local.port, receiver);
        discovery = _waiting.empty() ? Receiver{} : FindDiscoveryReceiver();
        if (discovery.Next != nullptr)
        {
            goodbyes.swap(_waiting);
        }
    }
    for (auto &[peer, goodbye] : goodbyes)
    {
        HandOnGoodbye(discovery, peer, goodbye);
    }
}

void VendorInput::NoteCardPort(std::uint32_t port)
{
    const std::lock_guard lock(_mutex);
    _cardPort = port;
}

Receiver VendorInput::DiscoveryReceiver() const
{
    const std::lock_guard lock(_mutex);
    return FindDiscoveryReceiver();
}

Receiver VendorInput::FindDiscoveryReceiver() const
{
    auto ports = _discoveryPorts;
    // The vendor does not announce the group that it listens to where samples do not go by multicast.
    ports.push_back(_groupPort);
    // A node without multicast that lists no peers announces itself only when it has heard of one.
    ports.push_back(_cardPort);
    for (const std::uint32_t port : ports)
    {
        if (const auto found = _receivers.find(port); found != _receivers.end())
        {
            return found->second;
        }
    }
    return {};
}

void VendorInput::HandOn(const Receiver &receiver, std::span<std::uint8_t> message)
{
    if (receiver.Next != nullptr)
    {
        receiver.Next->OnDataReceived(message.data(), static_cast<std::uint32_t>(message.size()),
                                      receiver.Local, receiver.Remote);
    }
}

void VendorInput::HandOnAsProtected(const Receiver &receiver, const GuidPrefix &peer,
                                    std::span<std::uint8_t> message)
{
    const GuidPrefix own = OwnPrefix();
    if (own == GuidPrefix{})
    {
        HandOn(receiver, message);
        return;
    }
    const std::lock_guard lock(_protecting);
    AsProtected(own, peer, [&] { HandOn(receiver, message); });
}

void VendorInput::HandOnAnnouncement(const Receiver &receiver, const GuidPrefix &peer)
{
    if (receiver.Next == nullptr)
    {
        return;  // the announcement stays until there is a receiver
    }
    if (auto announcement = _introductions.Take(peer); !announcement.empty())
    {
        HandOnAsProtected(receiver, peer, announcement);
    }
}

void VendorInput::Deliver(const Receiver &receiver, std::span<std::uint8_t> admitted)
{
    if (_introduces && _introductions.Read(admitted) == Introductions::Message::Goodbye)
    {
        HandOnAsProtected(receiver, SenderOf(admitted), admitted);
        return;
    }
    HandOn(receiver, admitted);
}

void VendorInput::Introduce(std::span<const std::uint8_t> datagram)
{
    const GuidPrefix peer = datagram.size() < RtpsHeaderSize ? GuidPrefix{} : SenderOf(datagram);
    if (!_introduces || !_introductions.Has(peer))
    {
        return;
    }
    const GuidPrefix own = OwnPrefix();
    if (own != GuidPrefix{} && KeyAddressees::IsAuthenticated(own, peer))
    {
        HandOnAnnouncement(DiscoveryReceiver(), peer);
    }
}

void VendorInput::Forget(const GuidPrefix &peer, std::span<std::uint8_t> goodbye)
{
    Receiver receiver;
    {
        const std::lock_guard lock(_mutex);
        receiver = FindDiscoveryReceiver();
        if (receiver.Next == nullptr)
        {
            if (_waiting.size() >= Introductions::MostPeers)
            {
                _waiting.erase(_waiting.begin());
            }
            _waiting.insert_or_assign(peer, std::vector(goodbye.begin(), goodbye.end()));
            return;
        }
    }
    HandOnGoodbye(receiver, peer, goodbye);
}

void VendorInput::HandOnGoodbye(const Receiver &receiver, const GuidPrefix &peer,
                                std::span<std::uint8_t> goodbye)
{
    // A vendor that waits for protected announcements heeds a goodbye only of participants of which it has
    // had one. Otherwise it would remember a failed handshake for good.
    HandOnAnnouncement(receiver, peer);
    HandOnAsProtected(receiver, peer, goodbye);
}

}  // namespace Rabit::FastDds
