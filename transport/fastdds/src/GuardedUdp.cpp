#include "GuardedUdp.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <utility>
#include <vector>

#include "AcknowledgementTranslator.h"
#include "AnnouncementPace.h"
#include "HeartbeatPace.h"
#include "KeyAddressees.h"
#include "OutgoingMessage.h"
#include "RequestPace.h"
#include "ShortenedDatagram.h"
#include "SocketOutput.h"
#include "VendorInput.h"
#include "common/HeldDatagrams.h"
#include "common/RtpsTraffic.h"
#include "common/RtpsWriter.h"
#include "common/SendingSamples.h"
#include "rtps/CardMessage.h"
#include "rtps/DiscoverySubmessages.h"

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
// callback is called with it held: a key exchange, for instance, may send on the thread that puts it.
class GuardedUdp final : public ChainedUdp
{
public:
    explicit GuardedUdp(const GuardedUdpDescriptor &descriptor)
        : ChainedUdp(descriptor),
          _descriptor(descriptor),
          _guard(descriptor.Chosen().Mode, descriptor.Chosen().AnnouncementPeriod, RtpsGuard::Vendor::FastDds,
                 descriptor.Chosen().Goodbyes, descriptor.Chosen().Accounts),
          _input(descriptor.Chosen().GroupPort,
                 AwaitsProtectedAnnouncements && descriptor.Chosen().Authentication != nullptr),
          _output(_descriptor.Chosen(), _guard, *low_level_transport_, _sending),
          _announcements(descriptor.Chosen().AnnouncementPeriod, descriptor.Chosen().Meeting != nullptr)
    {
        if (Keys() != nullptr)
        {
            Keys()->Start(
                [this](const Route &route, std::vector<std::uint8_t> &datagram)
                {
                    while (EndsLikeStatistics(datagram))
                    {
                        AppendSubmessageHeader(datagram, SubmessageKind::Pad, 0);
                    }
                    SendTo({route}, datagram);
                });
        }
        if (Envelope::SealedSession *const seal = Seal())
        {
            _guard.SetAuthority({.May = [seal](const auto &peer, bool write, auto topic)
                                 { return write ? seal->MayWrite(peer, topic) : seal->MayRead(peer, topic); },
                                 .NameOf = [seal](const auto &peer) { return seal->NameOf(peer); }});
        }
        if (MeetingThread *const meeting = Meeting())
        {
            _guard.SetObserver(*meeting);
            meeting->Start(
                {.Send = [this](const auto &to, auto datagram) { SendCard(to, datagram); },
                 .Deliver = [this](const auto &from, auto datagram) { DeliverCard(from, datagram); },
                 .LastHeard = [this](const auto &peer) { return _guard.LastHeard(peer); }});
        }
        if (AuthenticationThread *const authentication = Authentication())
        {
            _guard.SetAuthentication(*authentication);
            authentication->Start({.IsAuthenticated =
                                       [this](const auto &peer)
                                   {
                                       const GuidPrefix own = _input.OwnPrefix();
                                       return own != GuidPrefix{} && KeyAddressees::HasKeysOf(own, peer);
                                   },
                                   .Ask = nullptr,
                                   .IsWaiting = [this](const auto &peer) { return Keys()->IsWaiting(peer); },
                                   .AnswerTime = [this] { return Keys()->AnswerTime(); },
                                   .Forget = [this](const auto &peer, auto number) { Forget(peer, number); },
                                   .Drop = [this](const auto &peer) { Keys()->Forget(peer); }});
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
        if (AuthenticationThread *const authentication = Authentication())
        {
            authentication->Stop();
        }
        if (MeetingThread *const meeting = Meeting())
        {
            meeting->Stop();
        }
        if (Keys() != nullptr)
        {
            Keys()->Stop();
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
        OutgoingMessage message = ReadOutgoing(datagram.Bytes());
        message.HasSamples = message.HasSamples || SendingSamples::Now();
        if (!message.HasSamples && PutExchange(sender, datagram.Bytes(), begin, end))
        {
            return true;
        }
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
                if (!_descriptor.Chosen().SampleGroup)
                {
                    const std::lock_guard lock(_sending);
                    _output.HeardStranger(HostOf(remote), now);
                }
                return;
            }
        }
        const Receiver receiver{next, local, remote};
        if (Meeting() != nullptr || Authentication() != nullptr)
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
        if (Keys() != nullptr)
        {
            Keys()->Came(datagram);
        }
        const auto handOn = [&](std::span<std::uint8_t> admitted)
        {
            _translator.Translate(admitted);
            if (!NoteExchange(admitted))
            {
                return;
            }
            NoteAcknowledgements(admitted);
            _input.Deliver(receiver, admitted);
        };
        if (!_guard.Admit(datagram, HostOf(remote), std::chrono::steady_clock::now(), std::cref(handOn)))
        {
            _descriptor.Chosen().OnDropped();
        }
        if (_guard.TakeReplyDue())
        {
            _descriptor.Chosen().Announce();
        }
        _input.Introduce(datagram);
    }

private:
    using TimePoint = std::chrono::steady_clock::time_point;

    Envelope::SealedSession *Seal() const { return _descriptor.Chosen().Seal.get(); }
    MeetingThread *Meeting() const { return _descriptor.Chosen().Meeting.get(); }
    AuthenticationThread *Authentication() const { return _descriptor.Chosen().Authentication.get(); }
    // Makes the vendor forget a participant, and the participant this node. Runs on a thread without locks.
    void Forget(const GuidPrefix &peer, std::int64_t number)
    {
        const std::vector<std::uint8_t> own = _input.OwnAnnouncement();
        // First of all, so that no announcement comes in between.
        _descriptor.Chosen().Goodbyes->Ignore(peer, std::chrono::steady_clock::now());
        const auto ours = GoodbyeAfter(own, peer);
        SendCard(peer, ours);
        SendCard(std::nullopt, ours);
        auto theirs = GoodbyeOf(peer, own, number);
        _input.Forget(peer, theirs);
    }
    KeyThread *Keys() const { return _descriptor.Chosen().Keys.get(); }
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
        std::vector<Route> routes;
        {
            const std::lock_guard lock(_sending);
            routes = _output.RoutesTo(to, std::chrono::steady_clock::now());
        }
        SendTo(routes, datagram);
    }
    void SendTo(const std::vector<Route> &routes, std::span<const std::uint8_t> datagram)
    {
        const auto timeout = std::chrono::steady_clock::now() + SocketTimeout;
        std::unique_lock lock(_sending);
        for (const auto &[sender, destination] : routes)
        {
            _chosen.assign(1, destination);
            _output.Send(sender, _chosen, datagram, false, timeout, lock);
        }
    }
    // Runs on the thread of the SealedSession.
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
    // Takes a datagram of a key exchange, for each of its destinations. Returns false if it should be sent
    // unchanged; then no destination was passed over.
    bool PutExchange(rtps::SenderResource *sender, std::span<const std::uint8_t> datagram,
                     rtps::LocatorsIterator &begin, const rtps::LocatorsIterator &end)
    {
        const auto what = Keys() != nullptr ? ReadKeyExchange(datagram) : std::nullopt;
        for (; what && begin != end; ++begin)
        {
            std::unique_lock lock(_sending);
            if (_output.Leaves({sender, *begin}))
            {
                _output.NoteRoute(what->To, {sender, *begin});
                lock.unlock();
                if (Authentication() != nullptr && what->To != KeyExchange::Prefix{})
                {
                    Authentication()->Sent(*what);
                }
                if (!Keys()->Put(datagram, *what, {sender, *begin}))
                {
                    return false;  // no earlier one was put either
                }
            }
        }
        return what.has_value();
    }
    // Notes a received datagram. Returns false if the vendor should not see it.
    bool NoteExchange(std::span<const std::uint8_t> datagram)
    {
        const auto what = Keys() != nullptr ? ReadKeyExchange(datagram) : std::nullopt;
        if (what && Authentication() != nullptr && Keys()->IsForUs(*what))
        {
            Authentication()->Received(*what);
        }
        return !what || Keys()->Received(*what);
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
    for (DueThread *const thread : std::initializer_list<DueThread *>{
             _settings.Keys.get(), _settings.Meeting.get(), _settings.Authentication.get()})
    {
        if (thread != nullptr)
        {
            thread->Prepare();
        }
    }
}

TransportInterface *GuardedUdpDescriptor::create_transport() const
{
    return new GuardedUdp(*this);  // the vendor owns it
}

}  // namespace Rabit::FastDds
