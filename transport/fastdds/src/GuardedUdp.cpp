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
#include "RequestPace.h"
#include "common/DiscoveryOutbox.h"
#include "common/HeldDatagrams.h"
#include "common/KeyExchangeOutbox.h"
#include "common/SendingSamples.h"

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

HostAddress HostOf(const rtps::Locator_t &locator)
{
    HostAddress host = UnknownHost;
    if (locator.kind == LOCATOR_KIND_UDPv4)
    {
        std::copy_n(rtps::IPLocator::getIPv4(locator), host.size(), host.begin());
    }
    return host;
}

bool IsGroup(const rtps::Locator_t &locator)
{
    return rtps::IPLocator::isMulticast(locator);
}

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
        OutgoingMessage message = ReadOutgoing({buffer, left});
        message.HasSamples = message.HasSamples || SendingSamples::Now();
        if (const auto exchange = message.HasSamples ? std::nullopt : KeyExchangeOf({buffer, left});
            exchange && PutExchange(sender, {buffer, left}, *exchange, *begin, *end))
        {
            return true;
        }
        std::span<const std::uint8_t> datagram(buffer, left);
        if (message.Announcement && _descriptor.Chosen().Mode == RtpsGuard::Mode::Full)
        {
            WriteWithoutProperties(datagram, _shortened);
            datagram = _shortened;
        }
        const auto now = std::chrono::steady_clock::now();
        const std::uint32_t socket = NumberOf(sender);
        if (message.Request && !_requests.MayGo(socket, *message.Request, now))
        {
            return true;
        }
        const auto parts =
            message.HasSamples || message.Announcement ? std::nullopt : ReadDiscoveryParts(datagram);
        _chosen.clear();
        for (; *begin != *end; ++*begin)
        {
            const rtps::Locator_t &destination = **begin;
            const std::uint64_t number = std::uint64_t{socket} << 32 | NumberOf(destination);
            const bool held =
                (message.Announcement &&
                 !_announcements.MayGo(number, *message.Announcement, _guard.AnnouncementsHeard(), now)) ||
                (message.Heartbeat && !_heartbeats.MayGo(number, *message.Heartbeat, now)) ||
                (parts && Leaves(socket, destination) && Put(sender, destination, datagram, *parts, now));
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
        if (parts)
        {
            ScheduleOwed();
        }
        if (!message.HasSamples)
        {
            CountPast(sender, datagram, message.Announcement.has_value(), now);
        }
        if (message.IsOfSamplesToOne && std::none_of(_chosen.begin(), _chosen.end(), IsGroup))
        {
            WriteWithoutDestination(datagram, _shortened);
            datagram = _shortened;
        }
        return Hold(sender, datagram) || SendChosen(sender, datagram, message.HasSamples, timeout);
    }

    void receive(TransportReceiverInterface *next, const rtps::octet *buffer, std::uint32_t size,
                 const rtps::Locator_t &local, const rtps::Locator_t &remote) override
    {
        // The vendor's receive buffer, which is not used again before this returns.
        const std::span<std::uint8_t> datagram(const_cast<rtps::octet *>(buffer), size);
        const auto handOn = [&](std::span<std::uint8_t> admitted)
        {
            Translate(admitted);
            if (!NoteExchange(admitted))
            {
                return;
            }
            NoteAcknowledgements(admitted);
            next->OnDataReceived(admitted.data(), static_cast<std::uint32_t>(admitted.size()), local, remote);
        };
        if (!_guard.Admit(datagram, HostOf(remote), std::chrono::steady_clock::now(), std::cref(handOn)))
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
    // Whether that socket does send to a destination that it is given.
    bool Leaves(std::uint32_t socket, const rtps::Locator_t &destination) const
    {
        return _descriptor.Chosen().SocketsSendAll ||
               rtps::IPLocator::isMulticast(destination) != (socket == 0);
    }

    // Into the outbox, with _sending held. False if it is to go as it is.
    bool Put(rtps::SenderResource *sender, const rtps::Locator_t &destination,
             std::span<const std::uint8_t> datagram, const std::vector<DiscoveryPart> &parts, TimePoint now)
    {
        const bool toGroup = rtps::IPLocator::isMulticast(destination);
        if (toGroup && _groups.empty())
        {
            return false;
        }
        constexpr std::uint64_t Groups = 0;  // all of them
        const auto route = static_cast<std::uint64_t>(NumberOf(sender)) << 32 | NumberOf(destination);
        _routes.insert_or_assign(route, std::pair(sender, destination));
        _outbox.SetRate(_descriptor.Chosen().Pace->Get());
        for (const DiscoveryPart &part : parts)
        {
            const bool hears = toGroup || (!_groups.empty() && _descriptor.Chosen().IsInGroup(part.About.To));
            _outbox.Put(datagram, part,
                        {.Address = route, .Group = hears ? std::optional(Groups) : std::nullopt}, now);
        }
        _descriptor.Chosen().Pace->SetHeldUpSince(_outbox.HeldUpSince());
        return true;
    }
    std::size_t DatagramsTo(rtps::SenderResource *sender)
    {
        const std::uint32_t socket = NumberOf(sender);
        return static_cast<std::size_t>(std::count_if(_chosen.begin(), _chosen.end(),
                                                      [&](const rtps::Locator_t &destination)
                                                      { return Leaves(socket, destination); }));
    }
    // What goes to _chosen without waiting in the outbox.
    void CountPast(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram, bool announcement,
                   TimePoint now)
    {
        for (std::size_t i = DatagramsTo(sender); i > 0; --i)
        {
            announcement ? _outbox.Announced(datagram, now) : _outbox.Sent(datagram.size(), now);
        }
    }
    // To _chosen, with _sending held.
    bool SendChosen(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram, bool samples,
                    const TimePoint &timeout)
    {
        const std::size_t datagrams = DatagramsTo(sender);
        _descriptor.Chosen().OnSent(samples, datagrams, datagrams * datagram.size());
        ListIterator first(_chosen.cbegin());
        ListIterator last(_chosen.cend());
        return sender->send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), &first, &last,
                            timeout);
    }
    // Whether it waits for its turn, with _sending held (HeldDatagrams). The writer whose it is ends before
    // this.
    bool Hold(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram)
    {
        HeldDatagrams::Scope *const held = HeldDatagrams::OfThisThread();
        const std::size_t datagrams = held != nullptr ? DatagramsTo(sender) : 0;
        return datagrams > 0 &&
               held->Keep(datagrams * (HeldDatagrams::IpAndUdp + datagram.size()),
                          [this, sender, destinations = _chosen,
                           bytes = std::vector<std::uint8_t>(datagram.begin(), datagram.end())]
                          {
                              constexpr std::chrono::milliseconds LongestWait{100};
                              const std::lock_guard lock(_sending);
                              _chosen = destinations;
                              SendChosen(sender, bytes, true, std::chrono::steady_clock::now() + LongestWait);
                          });
    }
    void SendOwed()
    {
        constexpr std::chrono::milliseconds LongestWait{100};
        const std::lock_guard lock(_sending);
        const auto now = std::chrono::steady_clock::now();
        for (const auto delay : _descriptor.Chosen().Pace->TakeLate())
        {
            _outbox.CameLate(delay, now);
        }
        for (const DiscoveryOutbox::Datagram &owed : _outbox.TakeDue(now))
        {
            if (!owed.ToGroup)
            {
                const auto &[sender, destination] = _routes.at(owed.Address);
                _chosen.assign(1, destination);
                SendChosen(sender, owed.Bytes, false, now + LongestWait);
                continue;
            }
            for (const auto &[sender, group] : _groups)
            {
                _chosen.assign(1, group);
                SendChosen(sender, owed.Bytes, false, now + LongestWait);
            }
        }
        _descriptor.Chosen().Pace->SetHeldUpSince(_outbox.HeldUpSince());
        SendExchanges(now);
    }
    // With _sending held.
    void ScheduleOwed()
    {
        const auto discovery = _outbox.Due();
        const auto exchange = _exchanges.Due();
        if (discovery || exchange)
        {
            constexpr TimePoint Never = TimePoint::max();
            _descriptor.Chosen().SendOwedAt(std::min(discovery.value_or(Never), exchange.value_or(Never)));
        }
    }

    std::optional<KeyExchange> KeyExchangeOf(std::span<const std::uint8_t> datagram) const
    {
        return _descriptor.Chosen().Mode == RtpsGuard::Mode::Protected ? ReadKeyExchange(datagram)
                                                                       : std::nullopt;
    }
    // With _sending held, as for the next one. False if it is to go as it is.
    bool PutExchange(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram,
                     const KeyExchange &what, rtps::LocatorsIterator &begin,
                     const rtps::LocatorsIterator &end)
    {
        const auto now = std::chrono::steady_clock::now();
        const std::uint32_t socket = NumberOf(sender);
        _exchanges.SetRate(_descriptor.Chosen().Pace->Get());
        _self = what.From;
        for (; begin != end; ++begin)
        {
            if (Leaves(socket, *begin))
            {
                const auto route = static_cast<std::uint64_t>(socket) << 32 | NumberOf(*begin);
                _routes.insert_or_assign(route, std::pair(sender, *begin));
                if (!_exchanges.Put(datagram, what, route, now))
                {
                    return false;  // nor was any before
                }
            }
        }
        SendExchanges(now);
        return true;
    }
    void SendExchanges(TimePoint now)
    {
        constexpr std::chrono::milliseconds LongestWait{100};
        for (const KeyExchangeOutbox::Datagram &each : _exchanges.TakeDue(now))
        {
            const auto &[sender, destination] = _routes.at(each.Route);
            _chosen.assign(1, destination);
            SendChosen(sender, each.Bytes, false, now + LongestWait);
        }
        ScheduleOwed();
    }
    // Of what came. False if the vendor should not see it.
    bool NoteExchange(std::span<const std::uint8_t> datagram)
    {
        const auto what = KeyExchangeOf(datagram);
        if (!what)
        {
            return true;
        }
        const std::lock_guard lock(_sending);
        if (what->To != _self)
        {
            return true;
        }
        const bool isHeard = _exchanges.Received(*what, std::chrono::steady_clock::now());
        ScheduleOwed();
        return isHeard;
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
        _outbox.Received(datagram, now);
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
    DiscoveryOutbox _outbox;
    KeyExchangeOutbox _exchanges;
    GuidPrefix _self{};  // once something was exchanged
    std::map<std::uint64_t, std::pair<rtps::SenderResource *, rtps::Locator_t>> _routes;
    // Where announcements go to all.
    std::set<std::pair<rtps::SenderResource *, rtps::Locator_t>> _groups;
    std::map<rtps::Locator_t, std::uint32_t> _destinations;
    std::map<const rtps::SenderResource *, std::uint32_t> _senders;
    std::vector<rtps::Locator_t> _chosen;
    std::vector<std::uint8_t> _shortened;  // what goes, if it is less than the vendor says
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
