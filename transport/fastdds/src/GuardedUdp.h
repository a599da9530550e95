// UDP as the vendor does it, with three differences: datagrams of up to 64 kB are received whatever size we
// send, so that nodes with different settings understand each other; what is no sound RTPS is dropped before
// the vendor's parser sees it; and a peer that had lost us is heard when it acknowledges anew
// (AcknowledgementTranslator.h).
#pragma once

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <cstdint>
#include <functional>
#include <memory>

namespace Rabit::FastDds
{

class GuardedUdpDescriptor final : public eprosima::fastdds::rtps::ChainingTransportDescriptor
{
public:
    // Sends datagrams of at most `maxDatagram` bytes; calls `onDropped`, on the receiving thread, for each
    // one that it drops.
    GuardedUdpDescriptor(std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp,
                         std::uint32_t maxDatagram, std::function<void()> onDropped);

    eprosima::fastdds::rtps::TransportInterface *create_transport() const override;
    std::uint32_t max_message_size() const override { return maxMessageSize; }
    const std::function<void()> &OnDropped() const { return _onDropped; }

private:
    const std::function<void()> _onDropped;
};

}  // namespace Rabit::FastDds
