#include "GuardedUdp.h"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>

#include <chrono>
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

class GuardedUdp final : public ChainingTransport
{
public:
    explicit GuardedUdp(const GuardedUdpDescriptor &descriptor)
        : ChainingTransport(descriptor), _descriptor(descriptor), _guard(descriptor.Mode())
    {
    }

    TransportDescriptorInterface *get_configuration() override { return &_descriptor; }

    bool send(rtps::SenderResource *sender, const rtps::octet *buffer, std::uint32_t size,
              rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) override
    {
        const auto left = static_cast<std::uint32_t>(SizeWithoutStatistics({buffer, size}));
        _guard.Sending({buffer, left});
        return sender->send(buffer, left, begin, end, timeout);
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
            _descriptor.OnDropped()();
        }
    }

private:
    GuardedUdpDescriptor _descriptor;
    RtpsGuard _guard;
};

}  // namespace

GuardedUdpDescriptor::GuardedUdpDescriptor(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp, std::uint32_t maxDatagram,
    RtpsGuard::Mode mode, std::function<void()> onDropped)
    : ChainingTransportDescriptor(std::move(udp)), _mode(mode), _onDropped(std::move(onDropped))
{
    maxMessageSize = maxDatagram;
}

TransportInterface *GuardedUdpDescriptor::create_transport() const
{
    return new GuardedUdp(*this);  // the vendor owns it
}

}  // namespace Rabit::FastDds
