// UDP as the vendor does it, with three differences: datagrams of up to 64 kB are received whatever size we
// send, so that nodes with different settings understand each other; what the vendor's parser must not see is
// kept from it, and what it would not heed of a peer that had lost us is put into its form (RtpsGuard.h); and
// the vendor's statistics are not sent.
#pragma once

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <cstdint>
#include <functional>
#include <memory>

#include "RtpsGuard.h"

namespace Rabit::FastDds
{

class GuardedUdpDescriptor final : public eprosima::fastdds::rtps::ChainingTransportDescriptor
{
public:
    // Sends datagrams of at most `maxDatagram` bytes; calls `onDropped`, on the receiving thread, for each
    // one of which it keeps something back that an honest peer does not send.
    GuardedUdpDescriptor(std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp,
                         std::uint32_t maxDatagram, RtpsGuard::Mode mode, std::function<void()> onDropped);

    eprosima::fastdds::rtps::TransportInterface *create_transport() const override;
    std::uint32_t max_message_size() const override { return maxMessageSize; }
    RtpsGuard::Mode Mode() const { return _mode; }
    const std::function<void()> &OnDropped() const { return _onDropped; }

private:
    const RtpsGuard::Mode _mode;
    const std::function<void()> _onDropped;
};

}  // namespace Rabit::FastDds
