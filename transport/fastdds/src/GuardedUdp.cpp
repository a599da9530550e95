#include "GuardedUdp.h"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>

#include <mutex>
#include <utility>

#include "AcknowledgementTranslator.h"
#include "RtpsCheck.h"

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
        : ChainingTransport(descriptor), _descriptor(descriptor)
    {
    }

    TransportDescriptorInterface *get_configuration() override { return &_descriptor; }

    bool send(rtps::SenderResource *sender, const rtps::octet *buffer, std::uint32_t size,
              rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) override
    {
        return sender->send(buffer, size, begin, end, timeout);
    }

    void receive(TransportReceiverInterface *next, const rtps::octet *buffer, std::uint32_t size,
                 const rtps::Locator_t &local, const rtps::Locator_t &remote) override
    {
        if (IsSoundRtps({buffer, size}))
        {
            {
                // The buffer is the vendor's own for receiving, const only on the way through here.
                const std::lock_guard lock(_mutex);
                _acknowledgements.Translate({const_cast<rtps::octet *>(buffer), size});
            }
            next->OnDataReceived(buffer, size, local, remote);
            return;
        }
        _descriptor.OnDropped()();
    }

private:
    GuardedUdpDescriptor _descriptor;
    std::mutex _mutex;                            // several sockets receive at once
    AcknowledgementTranslator _acknowledgements;  // guarded by _mutex
};

}  // namespace

GuardedUdpDescriptor::GuardedUdpDescriptor(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp, std::uint32_t maxDatagram,
    std::function<void()> onDropped)
    : ChainingTransportDescriptor(std::move(udp)), _onDropped(std::move(onDropped))
{
    maxMessageSize = maxDatagram;
}

TransportInterface *GuardedUdpDescriptor::create_transport() const
{
    return new GuardedUdp(*this);  // the vendor owns it
}

}  // namespace Rabit::FastDds
