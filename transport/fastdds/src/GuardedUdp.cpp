#include "GuardedUdp.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "AcknowledgementTranslator.h"
#include "AnnouncementPace.h"
#include "HeartbeatPace.h"
#include "OutgoingMessage.h"
#include "RequestPace.h"
#include "ShortenedDatagram.h"
#include "SocketOutput.h"
#include "VendorInput.h"
#include "common/HeldDatagrams.h"
#include "common/RtpsTraffic.h"
#include "envelope/SessionPlaces.h"
#include "rtps/CardMessage.h"

namespace Rabit::FastDds
{

using namespace Rtps;

using rtps::TransportDescriptorInterface;
using rtps::TransportInterface;
using rtps::TransportReceiverInterface;

namespace
{

// How long a socket may take for a datagram that the vendor does not send at this moment. A socket that does
// not block takes no time.
constexpr std::chrono::milliseconds SocketTimeout{100};

// Orders the steps of a datagram: from the vendor to a socket (Send), and from a socket to the vendor
// (receive).
//
// The vendor calls Send on any thread, and receive on a thread for each port, at once. `_sending` guards all
// that chooses and counts what is sent. It is held while a datagram goes to the sockets, the meeting
// (MeetingThread::Sending), OnSent and AnnounceAt, but not while a datagram is sealed, which takes 50 us.
// Each writer of the vendor sends its datagrams one after the other, so they keep their order. No other
// callback is called with it held.
class GuardedUdp final : public ChainedUdp
{
public:
    explicit GuardedUdp(const GuardedUdpDescriptor &descriptor)
        : ChainedUdp(descriptor),
          _descriptor(descriptor),
          _guard(descriptor.Chosen().Mode, descriptor.Chosen().AnnouncementPeriod, RtpsGuard::Vendor::FastDds,
                 descriptor.Chosen().Goodbyes, descriptor.Chosen().Accounts),
          _input(descriptor.Chosen().GroupPort),
          _output(_descriptor.Chosen(), _guard, *low_level_transport_, _sending),
          _announcements(descriptor.Chosen().AnnouncementPeriod, descriptor.Chosen().Meeting != nullptr)
    {
        if (Envelope::SealedSession *const seal = Seal())
        {
            _guard.SetAuthority({.May = [seal](const auto &peer, bool write, auto topic)
                                 { return write ? seal->MayWrite(peer, topic) : seal->MayRead(peer, topic); },
                                 .NameOf = [seal](const auto &peer) { return seal->NameOf(peer); }});
        }
        if (MeetingThread *const meeting = Meeting())
        {
            _guard.SetObserver(*meeting);
            meeting->SetSelf(SenderOf(_descriptor.Chosen().Header));
            meeting->Start(
                {.Send = [this](const auto &to, auto datagram) { SendCard(to, datagram); },
                 .Deliver = [this](const auto &from, auto datagram) { DeliverCard(from, datagram); },
                 .LastHeard = [this](const auto &peer) { return _guard.LastHeard(peer); }});
        }
        // The vendor has no socket yet.
        if (Envelope::SealedSession *const seal = Seal())
        {
            const Envelope::RtpsHeader &vendor = _descriptor.Chosen().Header;
            const auto card = WriteCardMessage({.From = SenderOf(vendor)});
            Envelope::RtpsHeader own{};
            std::copy_n(card.begin(), own.size(), own.begin());
            seal->Start(vendor, own,
                        {.Send = [this](const auto & /*to*/, auto sealed) { SendSealed(sealed); },
                         .Log = _descriptor.Chosen().OnLine});
        }
    }
    ~GuardedUdp() override
    {
        if (Envelope::SealedSession *const seal = Seal())
        {
            seal->Stop();
        }
        if (MeetingThread *const meeting = Meeting())
        {
            meeting->Stop();
        }
    }

    TransportDescriptorInterface *get_configuration() override { return &_descriptor; }

    // The vendor takes another port for single addresses, and goes on without that of a group.
    bool OpenInputChannel(const rtps::Locator_t &locator, TransportReceiverInterface *receiver,
                          std::uint32_t largest) override
    {
        const bool isOpen = ChainedUdp::OpenInputChannel(locator, receiver, largest);
        if (!isOpen && IsGroup(locator))
        {
            _descriptor.Chosen().OnDeaf(locator.port);
        }
        return isOpen;
    }

    bool MaySendTo(const rtps::Locator_t &remote) const override
    {
        const std::uint32_t port = _descriptor.Chosen().GroupPort;
        return port == 0 || port == remote.port || !IsGroup(remote);
    }

    // The vendor calls it with a lock held that it also holds for OpenOutputChannel. Our own lock costs
    // little beside that, and does not rely on it.
    bool Send(rtps::SenderResource &to, std::span<const std::uint8_t> whole, rtps::LocatorsIterator &begin,
              rtps::LocatorsIterator &end, const std::chrono::steady_clock::time_point &timeout) override
    {
        rtps::SenderResource *const sender = &to;
        thread_local std::vector<std::uint8_t> copy;
        ShortenedDatagram datagram(whole, copy);
        _guard.Sending(datagram.Bytes());
        const OutgoingMessage message = ReadOutgoing(datagram.Bytes());
        if (message.Announcement)
        {
            _input.NoteOwn(datagram.Bytes());
        }
        std::unique_lock lock(_sending);
        if (message.Announcement && _descriptor.Chosen().Mode == RtpsGuard::Mode::Full)
        {
            datagram.LeaveOutProperties();
        }
        if (Meeting() != nullptr && !message.HasSamples && Meeting()->Sending(datagram.Bytes()))
        {
            NoteRoute(sender, datagram.Bytes(), begin, end);
            return true;
        }
        const auto now = std::chrono::steady_clock::now();
        if (message.Request && !_requests.MayGo(_output.NumberOf(sender), *message.Request, now))
        {
            return true;
        }
        _chosen.clear();
        for (; begin != end; ++begin)
        {
            const rtps::Locator_t &destination = *begin;
            const std::uint64_t number = _output.NumberOf({sender, destination});
            const bool held =
                (message.Announcement &&
                 !_announcements.MayGo(number, *message.Announcement, _guard.AnnouncementsHeard(), now)) ||
                (message.Heartbeat && !_heartbeats.MayGo(number, *message.Heartbeat, now));
            if (!held)
            {
                _chosen.push_back(destination);
            }
            if (message.Announcement && (IsGroup(destination) || HasOtherWaysToAll()))
            {
                _output.NoteAnnounced({sender, destination}, now);
            }
        }
        if (message.Announcement)
        {
            if (const auto due = _announcements.Due())
            {
                _descriptor.Chosen().AnnounceAt(*due);
            }
        }
        // A datagram that is held now chooses its way when it is sent.
        if (message.HasSamples && HeldDatagrams::OfThisThread() == nullptr)
        {
            _output.ChooseGroupWhereAddressesLack(sender, message.IsOfSamplesToOne, now, _chosen);
        }
        if (message.IsOfSamplesToOne && std::none_of(_chosen.begin(), _chosen.end(), IsGroup))
        {
            datagram.LeaveOutDestination();
        }
        if (Seal() == nullptr)
        {
            datagram.PutBackStatistics();
        }
        return Hold(sender, datagram.Bytes()) ||
               _output.Send(sender, _chosen, datagram.Bytes(), message.HasSamples, timeout, lock);
    }

    void receive(TransportReceiverInterface *next, const rtps::octet *buffer, std::uint32_t size,
                 const rtps::Locator_t &local, const rtps::Locator_t &remote) override
    {
        if (IsGroup(local) && !_descriptor.Chosen().Networks.MayComeFrom(HostOf(remote)))
        {
            return;
        }
        // This is the vendor's receive buffer, which is not reused before this returns.
        std::span<std::uint8_t> datagram(const_cast<rtps::octet *>(buffer), size);
        if (Seal() != nullptr)
        {
            const auto now = std::chrono::steady_clock::now();
            datagram = Seal()->Open(datagram, PlaceOf(remote), now);
            if (datagram.empty())
            {
                return;
            }
        }
        NoteHeard(datagram, remote);
        const Receiver receiver{next, local, remote};
        if (Meeting() != nullptr)
        {
            _input.NoteReceiver(receiver);
        }
        if (Meeting() != nullptr && IsCardMessage(datagram))
        {
            if (Meeting()->Received(datagram, HostOf(remote), _guard.IsKnownAt(datagram, HostOf(remote))))
            {
                _input.NoteCardPort(local.port);
            }
            else
            {
                _descriptor.Chosen().OnDropped();
            }
            return;
        }
        const auto handOn = [&](std::span<std::uint8_t> admitted)
        {
            _translator.Translate(admitted);
            NoteAcknowledgements(admitted);
            VendorInput::HandOn(receiver, admitted);
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
    Envelope::SealedSession *Seal() const { return _descriptor.Chosen().Seal.get(); }
    MeetingThread *Meeting() const { return _descriptor.Chosen().Meeting.get(); }
    // True if the group does not reach all: peers are listed, or, for what introduces a SealedSession, known.
    bool HasOtherWaysToAll() const
    {
        const GuardedUdpDescriptor::Settings &chosen = _descriptor.Chosen();
        return chosen.HasPeers || (chosen.Seal != nullptr && !chosen.SampleGroup);
    }
    // Notes the address of a participant to which the vendor sends. Requires _sending.
    void NoteRoute(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram,
                   rtps::LocatorsIterator &begin, const rtps::LocatorsIterator &end)
    {
        const GuidPrefix to = DestinationOf(datagram);
        for (; to != GuidPrefix{} && begin != end; ++begin)
        {
            if (_output.Leaves({sender, *begin}) && !IsGroup(*begin))
            {
                _output.NoteRoute(to, {sender, *begin});
            }
        }
    }
    // Runs on the meeting's thread, or on that of the session's holder (DiscoveryTurns).
    void SendCard(const std::optional<GuidPrefix> &to, std::span<const std::uint8_t> datagram)
    {
        const auto now = std::chrono::steady_clock::now();
        std::unique_lock lock(_sending);
        _output.SendCard(to, datagram, now, now + SocketTimeout, lock);
    }
    // Without multicast a node that lists no peers learns by an announcement where to ask for the card.
    void NoteHeard(std::span<const std::uint8_t> datagram, const rtps::Locator_t &remote)
    {
        if (Meeting() == nullptr || _descriptor.Chosen().SampleGroup || !AnnouncingOf(datagram).Any)
        {
            return;
        }
        const auto announced = Envelope::ReadAnnouncedPlaces(datagram);
        const auto at = announced.HasCard ? announced.DiscoveryAt(HostOf(remote)) : std::nullopt;
        if (at && !Meeting()->IsSelf(SenderOf(datagram)))
        {
            const std::lock_guard lock(_sending);
            _output.NoteHeard(SenderOf(datagram), *at, std::chrono::steady_clock::now());
        }
    }
    // Runs on the thread of the SealedSession, or on that of the session's holder (DiscoveryTurns).
    void SendSealed(std::span<const std::uint8_t> sealed)
    {
        const auto now = std::chrono::steady_clock::now();
        const std::lock_guard lock(_sending);
        _output.SendSealed(sealed, now, now + SocketTimeout);
    }

    // Runs on the meeting's thread. The vendor accepts datagrams on several threads.
    void DeliverCard(const HostAddress &from, std::span<std::uint8_t> datagram)
    {
        const Receiver receiver = _input.DiscoveryReceiver();
        const auto handOn = [&](std::span<std::uint8_t> admitted)
        { VendorInput::HandOn(receiver, admitted); };
        if (receiver.Next != nullptr && !_guard.Admit(datagram, from, std::chrono::steady_clock::now(),
                                                      std::cref(handOn), RtpsGuard::Origin::Card))
        {
            _descriptor.Chosen().OnDropped();
        }
    }

    // Returns true if the datagram is held for SendHeld (HeldDatagrams). Requires _sending. The writer, which
    // owns the held datagrams, is destroyed before this object.
    bool Hold(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram)
    {
        HeldDatagrams::Scope *const held = HeldDatagrams::OfThisThread();
        const std::size_t datagrams = held != nullptr ? _output.DatagramsTo(sender, _chosen) : 0;
        return datagrams > 0 &&
               held->Keep(datagrams * (HeldDatagrams::IpAndUdp + datagram.size() + _output.MostAdded()),
                          [this, sender, destinations = _chosen,
                           bytes = std::vector<std::uint8_t>(datagram.begin(), datagram.end())]() mutable
                          {
                              const auto now = std::chrono::steady_clock::now();
                              std::unique_lock lock(_sending);
                              _output.ChooseGroupWhereAddressesLack(sender, false, now, destinations);
                              _output.Send(sender, destinations, bytes, true, now + SocketTimeout, lock);
                          });
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

    GuardedUdpDescriptor _descriptor;
    RtpsGuard _guard;
    VendorInput _input;
    AcknowledgementTranslator _translator;
    std::mutex _sending;  // guards the members below
    SocketOutput _output;
    AnnouncementPace _announcements;
    RequestPace _requests;
    HeartbeatPace _heartbeats;
    SocketOutput::Destinations _chosen;  // of the datagram to send
};

}  // namespace

GuardedUdpDescriptor::GuardedUdpDescriptor(std::shared_ptr<rtps::UDPv4TransportDescriptor> udp,
                                           Settings settings)
    : ChainingTransportDescriptor(std::move(udp)), _settings(std::move(settings))
{
    maxMessageSize = _settings.MaxDatagram;
    // The vendor calls create_transport, and is not prepared for an exception there.
    if (_settings.Meeting != nullptr)
    {
        _settings.Meeting->Prepare();
    }
}

TransportInterface *GuardedUdpDescriptor::create_transport() const
{
    return new GuardedUdp(*this);  // the vendor owns it
}

}  // namespace Rabit::FastDds
