// The vendor's UDP transport, with six differences:
// - Datagrams of up to 64 kB are received whatever size we send, so that nodes with different settings
//   understand each other.
// - The guard filters what the vendor's parser reads, and acknowledgements of a peer that had lost us are put
//   into the vendor's form (RtpsGuard.h, AcknowledgementTranslator.h).
// - Multicast groups that peers name are not sent to where multicast may not pass.
// - The vendor's statistics are not sent, but for one message of 256 (ShortenedDatagram.h).
// - Datagrams that the vendor repeats too quickly, or sends to each peer by itself, are rate-limited
//   (AnnouncementPace.h, RequestPace.h, HeartbeatPace.h) or replaced by cards (rtps/Meeting.h).
// - With a member of a fleet with keys, each datagram is sealed before it goes to a socket, and what does not
//   open is dropped before anything else looks at it (envelope/SealedSession.h).
// VendorInput.h hands datagrams to the vendor, SocketOutput.h gives them to the sockets.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Vendor.h"
#include "common/OwnNetworks.h"
#include "common/SendingTurn.h"
#include "envelope/SealedSession.h"
#include "guard/RtpsGuard.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

// A socket of the vendor's, and an address.
using Route = std::pair<rtps::SenderResource *, rtps::Locator_t>;

class GuardedUdpDescriptor final : public rtps::ChainingTransportDescriptor
{
public:
    struct Settings
    {
        // Bytes, before they are sealed; larger ones are not sent.
        std::uint32_t MaxDatagram = 0;
        Rtps::RtpsGuard::Mode Mode = Rtps::RtpsGuard::Mode::Full;
        // Multicast groups of peers are sent to at this port only; 0: never.
        std::uint32_t GroupPort = 0;
        // True if interfaces are named: the vendor then has one socket for each, which sends everything.
        // Otherwise its first socket sends to single addresses and to groups inside the host, and each other
        // socket, one for each network, sends to groups.
        bool SocketsSendAll = false;
        // Called, on the receiving thread, for each datagram of which the guard kept something back that an
        // honest peer does not send.
        std::function<void()> OnDropped{};
        // Called, on the thread that makes the participant, if no datagrams to groups can be received at this
        // port.
        std::function<void(std::uint32_t port)> OnDeaf{};
        // Called, on any thread, each time that a datagram is given to a socket, with the numbers to count.
        std::function<void(bool samples, std::size_t datagrams, std::size_t bytes)> OnSent{};
        // The turn that keeps the datagrams of samples of its thread.
        std::shared_ptr<SendingTurn> Sending = std::make_shared<SendingTurn>();
        // Called, on the receiving thread, when the participant should be announced to a peer that has not
        // heard it.
        std::function<void()> Announce{};
        // Announcement period of the vendor. The participant should also be announced at the time with which
        // AnnounceAt was last called, on any thread with the vendor's locks held.
        std::chrono::milliseconds AnnouncementPeriod{0};
        std::function<void(std::chrono::steady_clock::time_point)> AnnounceAt{};
        // Null: datagrams go as they are.
        std::shared_ptr<Envelope::SealedSession> Seal{};
        // The RTPS header with which the vendor's datagrams begin, but for the minor version.
        Envelope::RtpsHeader Header{};
        // With Seal: takes log lines, on any thread.
        std::function<void(const std::string &)> OnLine{};
        // With Seal: the ports at which the first participants of a host take discovery data.
        std::vector<std::uint16_t> DiscoveryPorts{};
        // Null: endpoints are found by the vendor's discovery alone.
        std::shared_ptr<Rtps::MeetingThread> Meeting{};
        // Where the guard notes the goodbyes of known participants.
        std::shared_ptr<Rtps::RecentGoodbyes> Goodbyes = std::make_shared<Rtps::RecentGoodbyes>();
        // Where the guard keeps the accounts of participants.
        std::shared_ptr<Rtps::Ledger> Accounts = std::make_shared<Rtps::Ledger>();
        // The group to which samples go; empty: they go to each host separately.
        std::optional<rtps::Locator_t> SampleGroup{};
        // Peers are listed; they may not hear the group.
        bool HasPeers = false;
        // The networks of the named interfaces.
        OwnNetworks Networks{{}, {}};
    };

    GuardedUdpDescriptor(std::shared_ptr<rtps::UDPv4TransportDescriptor> udp, Settings settings);

    rtps::TransportInterface *create_transport() const override;
    std::uint32_t max_message_size() const override { return maxMessageSize; }
    const Settings &Chosen() const { return _settings; }

private:
    const Settings _settings;
};

}  // namespace Rabit::FastDds
