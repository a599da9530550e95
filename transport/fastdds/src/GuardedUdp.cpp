#include "GuardedUdp.h"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <functional>
#include <set>
#include <utility>

namespace Rabit::FastDds
{

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::ChainingTransport;
using eprosima::fastdds::rtps::TransportDescriptorInterface;
using eprosima::fastdds::rtps::TransportInterface;
using eprosima::fastdds::rtps::TransportReceiverInterface;

namespace
{

// Tells of each destination as it is looked at.
class UsedLocators final : public rtps::LocatorsIterator
{
public:
    UsedLocators(rtps::LocatorsIterator &inner, const std::function<void(const rtps::Locator_t &)> &use)
        : _inner(inner), _use(use)
    {
    }

    rtps::LocatorsIterator &operator++() override
    {
        ++_inner;
        return *this;
    }
    bool operator==(const rtps::LocatorsIterator &other) const override
    {
        return _inner == static_cast<const UsedLocators &>(other)._inner;
    }
    bool operator!=(const rtps::LocatorsIterator &other) const override { return !(*this == other); }
    const rtps::Locator_t &operator*() const override
    {
        const rtps::Locator_t &locator = *_inner;
        _use(locator);
        return locator;
    }

private:
    rtps::LocatorsIterator &_inner;
    const std::function<void(const rtps::Locator_t &)> &_use;
};

class GuardedUdp final : public ChainingTransport
{
public:
    explicit GuardedUdp(const GuardedUdpDescriptor &descriptor)
        : ChainingTransport(descriptor), _descriptor(descriptor), _guard(descriptor.Chosen().Mode)
    {
    }

    TransportDescriptorInterface *get_configuration() override { return &_descriptor; }

    bool transform_remote_locator(const rtps::Locator_t &remote, rtps::Locator_t &result) const override
    {
        const std::uint32_t port = _descriptor.Chosen().GroupPort;
        return (port == 0 || port == remote.port || !rtps::IPLocator::isMulticast(remote)) &&
               low_level_transport_->transform_remote_locator(remote, result);
    }

    // The vendor calls it with a lock held that it holds for OpenOutputChannel, too.
    bool send(rtps::SenderResource *sender, const rtps::octet *buffer, std::uint32_t size,
              rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) override
    {
        const auto left = static_cast<std::uint32_t>(SizeWithoutStatistics({buffer, size}));
        _guard.Sending({buffer, left});
        const std::function<void(const rtps::Locator_t &)> use = [this](const rtps::Locator_t &destination)
        { Use(destination); };
        UsedLocators first(*begin, use);
        UsedLocators last(*end, use);
        return sender->send(buffer, left, &first, &last, timeout);
    }

    void receive(TransportReceiverInterface *next, const rtps::octet *buffer, std::uint32_t size,
                 const rtps::Locator_t &local, const rtps::Locator_t &remote) override
    {
        // The vendor's receive buffer, which is not used again before this returns.
        const std::span<std::uint8_t> datagram(const_cast<rtps::octet *>(buffer), size);
        const auto handOn = [&](std::span<const std::uint8_t> admitted) {
            next->OnDataReceived(admitted.data(), static_cast<std::uint32_t>(admitted.size()), local, remote);
        };
        if (!_guard.Admit(datagram, std::chrono::steady_clock::now(), std::cref(handOn)))
        {
            _descriptor.Chosen().OnDropped();
        }
        if (_guard.TakeReplyDue())
        {
            _descriptor.Chosen().Announce();
        }
    }

private:
    // The vendor's sockets know those destinations alone that a writer means to use when it matches, and end
    // the process at an assertion when it then uses another one: the reader's own address, where several
    // share a group.
    void Use(const rtps::Locator_t &destination)
    {
        if (_destinations.insert(destination).second)
        {
            // Makes no sockets: there are some, one of them is about to send.
            low_level_transport_->OpenOutputChannel(_noSockets, destination);
        }
    }

    GuardedUdpDescriptor _descriptor;
    RtpsGuard _guard;
    std::set<rtps::Locator_t> _destinations;
    eprosima::fastdds::rtps::SendResourceList _noSockets;
};

}  // namespace

GuardedUdpDescriptor::GuardedUdpDescriptor(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp, Settings settings)
    : ChainingTransportDescriptor(std::move(udp)), _settings(std::move(settings))
{
    maxMessageSize = _settings.MaxDatagram;
}

TransportInterface *GuardedUdpDescriptor::create_transport() const
{
    return new GuardedUdp(*this);  // the vendor owns it
}

}  // namespace Rabit::FastDds
