#include "VendorInput.h"

#include <utility>

#include "OutgoingMessage.h"

namespace Rabit::FastDds
{

void VendorInput::NoteOwn(std::span<const std::uint8_t> announcement)
{
    auto ports = DiscoveryPortsOf(announcement);
    const std::lock_guard lock(_mutex);
    _discoveryPorts = std::move(ports);
}

void VendorInput::NoteReceiver(const Receiver &receiver)
{
    const std::lock_guard lock(_mutex);
    _receivers.insert_or_assign(receiver.Local.port, receiver);
}

void VendorInput::NoteCardPort(std::uint32_t port)
{
    const std::lock_guard lock(_mutex);
    _cardPort = port;
}

Receiver VendorInput::DiscoveryReceiver() const
{
    const std::lock_guard lock(_mutex);
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

}  // namespace Rabit::FastDds
