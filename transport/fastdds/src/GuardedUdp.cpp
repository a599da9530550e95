#include "GuardedUdp.h"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "AcknowledgementTranslator.h"
#include "AnnouncementPace.h"
#include "HeartbeatPace.h"
#include "OutgoingMessage.h"
#include "RepairPace.h"
#include "RequestPace.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::ChainingTransport;
using eprosima::fastdds::rtps::TransportDescriptorInterface;
using eprosima::fastdds::rtps::TransportInterface;
using eprosima::fastdds::rtps::TransportReceiverInterface;

namespace
{

class ListIterator final : public rtps::LocatorsIterator
{
public:
    explicit ListIterator(std::vector<rtps::Locator_t>::const_iterator at) : _at(at) {}

    rtps::LocatorsIterator &operator++() override
    {
        ++_at;
        return *this;
    }
    bool operator==(const rtps::LocatorsIterator &other) const override
    {
        return _at == static_cast<const ListIterator &>(other)._at;
    }
    bool operator!=(const rtps::LocatorsIterator &other) const override { return !(*this == other); }
    const rtps::Locator_t &operator*() const override { return *_at; }

private:
    std::vector<rtps::Locator_t>::const_iterator _at;
};

class GuardedUdp final : public ChainingTransport
{
public:
    explicit GuardedUdp(const GuardedUdpDescriptor &descriptor)
        : ChainingTransport(descriptor),
          _descriptor(descriptor),
          _guard(descriptor.Chosen().Mode, descriptor.Chosen().AnnouncementPeriod),
          _announcements(descriptor.Chosen().AnnouncementPeriod)
    {
        _descriptor.Chosen().Owed->Set([this] { SendOwed(); });
    }
    ~GuardedUdp() override { _descriptor.Chosen().Owed->Set({}); }

    TransportDescriptorInterface *get_configuration() override { return &_descriptor; }

    bool transform_remote_locator(const rtps::Locator_t &remote, rtps::Locator_t &result) const override
    {
        const std::uint32_t port = _descriptor.Chosen().GroupPort;
        return (port == 0 || port == remote.port || !rtps::IPLocator::isMulticast(remote)) &&
               low_level_transport_->transform_remote_locator(remote, result);
    }

    // The vendor calls it with a lock held that it holds for OpenOutputChannel, too. Ours costs little beside
    // it, and relies on nothing.
    bool send(rtps::SenderResource *sender, const rtps::octet *buffer, std::uint32_t size,
              rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) override
    {
        const std::lock_guard lock(_sending);
        const auto left = static_cast<std::uint32_t>(SizeWithoutStatistics({buffer, size}));
        _guard.Sending({buffer, left});
        const OutgoingMessage message = ReadOutgoing({buffer, left});
        const auto now = std::chrono::steady_clock::now();
        const std::uint32_t socket = NumberOf(sender);
        if (message.Request && !_requests.MayGo(socket, *message.Request, now))
        {
            return true;
        }
        if (message.Endpoints && _descriptor.Chosen().IsInGroup(message.Endpoints->Peer) && !_groups.empty())
        {
            // The vendor gives it to each of its sockets.
            return socket != 0 || SendToAll({buffer, left}, message.Endpoints->Content, now, timeout);
        }
        _chosen.clear();
        for (; *begin != *end; ++*begin)
        {
            const rtps::Locator_t &destination = **begin;
            const std::uint64_t number = std::uint64_t{socket} << 32 | NumberOf(destination);
            const bool held =
                (message.Announcement &&
                 !_announcements.MayGo(number, *message.Announcement, _guard.AnnouncementsHeard(), now)) ||
                (message.Heartbeat && !_heartbeats.MayGo(number, *message.Heartbeat, now));
            if (!held)
            {
                _chosen.push_back(destination);
            }
            if (message.Announcement && rtps::IPLocator::isMulticast(destination))
            {
                _groups.emplace(sender, destination);
            }
        }
        if (message.Announcement)
        {
            if (const auto due = _announcements.Due())
            {
                _descriptor.Chosen().AnnounceAt(*due);
            }
        }
        return SendChosen(sender, {buffer, left}, message.HasSamples, timeout);
    }

    void receive(TransportReceiverInterface *next, const rtps::octet *buffer, std::uint32_t size,
                 const rtps::Locator_t &local, const rtps::Locator_t &remote) override
    {
        // The vendor's receive buffer, which is not used again before this returns.
        const std::span<std::uint8_t> datagram(const_cast<rtps::octet *>(buffer), size);
        const auto handOn = [&](std::span<std::uint8_t> admitted)
        {
            Translate(admitted);
            NoteAcknowledgements(admitted);
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
    using TimePoint = std::chrono::steady_clock::time_point;

    // To _chosen, with _sending held.
    bool SendChosen(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram, bool samples,
                    const TimePoint &timeout)
    {
        const bool isFirst = NumberOf(sender) == 0;
        const auto leaves = [&](const rtps::Locator_t &destination) {
            return _descriptor.Chosen().SocketsSendAll ||
                   rtps::IPLocator::isMulticast(destination) != isFirst;
        };
        const auto datagrams =
            static_cast<std::size_t>(std::count_if(_chosen.begin(), _chosen.end(), leaves));
        _descriptor.Chosen().OnSent(samples, datagrams, datagrams * datagram.size());
        ListIterator first(_chosen.cbegin());
        ListIterator last(_chosen.cend());
        return sender->send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), &first, &last,
                            timeout);
    }

    // What somebody lacks of our endpoints, with _sending held.
    bool SendToAll(std::span<const std::uint8_t> datagram, std::uint64_t content, TimePoint now,
                   const TimePoint &timeout)
    {
        auto forAll = ForAll(datagram);
        if (_repairs.MayGo(content, now))
        {
            return SendToGroups(forAll, timeout);
        }
        _owed.insert_or_assign(content, std::move(forAll));
        _descriptor.Chosen().SendOwedAt(*_repairs.Due());
        return true;
    }
    bool SendToGroups(std::span<const std::uint8_t> datagram, const TimePoint &timeout)
    {
        bool sent = true;
        for (const auto &[sender, group] : _groups)
        {
            _chosen.assign(1, group);
            sent = SendChosen(sender, datagram, false, timeout) && sent;
        }
        return sent;
    }
    void SendOwed()
    {
        constexpr std::chrono::milliseconds LongestWait{100};
        const std::lock_guard lock(_sending);
        const auto now = std::chrono::steady_clock::now();
        for (const std::uint64_t content : _repairs.TakeDue(now))
        {
            if (const auto owed = _owed.extract(content); !owed.empty())
            {
                SendToGroups(owed.mapped(), now + LongestWait);
            }
        }
        if (const auto due = _repairs.Due())
        {
            _descriptor.Chosen().SendOwedAt(*due);
        }
    }

    void Translate(std::span<std::uint8_t> datagram)
    {
        const std::lock_guard lock(_receiving);
        _translator.Translate(datagram);
    }
    void NoteAcknowledgements(std::span<const std::uint8_t> datagram)
    {
        const auto found = ReadAcknowledgements(datagram);
        if (found.empty())
        {
            return;
        }
        const auto now = std::chrono::steady_clock::now();
        const std::lock_guard lock(_sending);
        for (const Acknowledgement &acknowledgement : found)
        {
            _heartbeats.OnAcknowledgement(acknowledgement, now);
        }
    }

    // The vendor's sockets know those destinations alone that a writer means to use when it matches, and end
    // the process at an assertion when it then uses another one: the reader's own address, where several
    // share a group.
    std::uint32_t NumberOf(const rtps::Locator_t &destination)
    {
        const auto number = static_cast<std::uint32_t>(_destinations.size());
        const auto [found, isNew] = _destinations.emplace(destination, number);
        if (isNew)
        {
            // Makes no sockets: there are some, one of them is about to send.
            low_level_transport_->OpenOutputChannel(_noSockets, destination);
        }
        return found->second;
    }
    std::uint32_t NumberOf(const rtps::SenderResource *sender)
    {
        return _senders.emplace(sender, static_cast<std::uint32_t>(_senders.size())).first->second;
    }

    GuardedUdpDescriptor _descriptor;
    RtpsGuard _guard;
    std::mutex _receiving;                  // several sockets receive at once
    AcknowledgementTranslator _translator;  // guarded by _receiving
    std::mutex _sending;                    // guards what follows
    AnnouncementPace _announcements;
    RequestPace _requests;
    HeartbeatPace _heartbeats;
    RepairPace _repairs;
    std::map<std::uint64_t, std::vector<std::uint8_t>> _owed;  // content -> what goes to the groups
    // Where announcements go to all.
    std::set<std::pair<rtps::SenderResource *, rtps::Locator_t>> _groups;
    std::map<rtps::Locator_t, std::uint32_t> _destinations;
    std::map<const rtps::SenderResource *, std::uint32_t> _senders;
    std::vector<rtps::Locator_t> _chosen;
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
