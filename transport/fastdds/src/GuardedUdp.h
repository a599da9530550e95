// UDP as the vendor does it, with five differences: datagrams of up to 64 kB are received whatever size we
// send, so that nodes with different settings understand each other; what the vendor's parser must not see is
// kept from it, and what it would not heed of a peer that had lost us is put into its form (RtpsGuard.h);
// multicast groups that peers name are not sent to where multicast may not pass; the vendor's statistics are
// not sent; and what it repeats in haste, or says to each by itself, goes at a measured pace
// (AnnouncementPace.h, RequestPace.h, HeartbeatPace.h, common/KeyExchangeOutbox.h), or by cards
// (rtps/Meeting.h).
#pragma once

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "DeferredCall.h"
#include "common/DiscoveryRate.h"
#include "guard/RtpsGuard.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

class GuardedUdpDescriptor final : public eprosima::fastdds::rtps::ChainingTransportDescriptor
{
public:
    struct Settings
    {
        std::uint32_t MaxDatagram = 0;  // bytes; larger ones are not sent
        Rtps::RtpsGuard::Mode Mode = Rtps::RtpsGuard::Mode::Full;
        // Multicast groups of peers are sent to at this port only; 0: at all.
        std::uint32_t GroupPort = 0;
        // Interfaces are named, and the vendor has one socket for each, which sends all. Else its first
        // socket sends to single addresses, and to groups inside the host; all others, one for each network,
        // to groups.
        bool SocketsSendAll = false;
        // Called, on the receiving thread, for each datagram of which something is kept back that an honest
        // peer does not send.
        std::function<void()> OnDropped;
        // Called, on any thread, for each time that a datagram is given to a socket, with what has to be
        // counted.
        std::function<void(bool samples, std::size_t datagrams, std::size_t bytes)> OnSent;
        // Called, on the receiving thread, when the participant is to announce itself to somebody who has not
        // heard it.
        std::function<void()> Announce;
        // How often the vendor has it announce itself. Besides, it is to do so at the time with which
        // AnnounceAt was called last, on any thread with the vendor's locks held.
        std::chrono::milliseconds AnnouncementPeriod{0};
        std::function<void(std::chrono::steady_clock::time_point)> AnnounceAt;
        // Whether a participant listens to the group of discovery. Called, on any thread, with the vendor's
        // locks held.
        std::function<bool(const Rtps::GuidPrefix &)> IsInGroup;
        // Called, on any thread with the vendor's locks held: Owed is to be run at that time, the last that
        // was named, on a thread without locks.
        std::function<void(std::chrono::steady_clock::time_point)> SendOwedAt;
        std::shared_ptr<DeferredCall> Owed;
        // Null: endpoints are found as the vendor does it alone.
        std::shared_ptr<Rtps::MeetingThread> Meeting;
        // The group to which samples go; empty: they go to each host by itself.
        std::optional<eprosima::fastrtps::rtps::Locator_t> SampleGroup;
        // Peers are listed, who may not hear the group.
        bool HasPeers = false;
        std::shared_ptr<DiscoveryRate> Rate;
    };

    GuardedUdpDescriptor(std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp,
                         Settings settings);

    eprosima::fastdds::rtps::TransportInterface *create_transport() const override;
    std::uint32_t max_message_size() const override { return maxMessageSize; }
    const Settings &Chosen() const { return _settings; }

private:
    const Settings _settings;
};

}  // namespace Rabit::FastDds
