#include "guard/RtpsGuard.h"

#include <algorithm>
#include <utility>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/DiscoveryCheck.h"
#include "guard/KeyedEnd.h"

namespace Rabit::Rtps
{

namespace
{

bool HasSize(const Submessage &submessage, std::size_t size)
{
    return submessage.Body().size() >= size;
}

// Time of an INFO_TS: seconds, and their fractions.
std::uint64_t StampOf(const Submessage &submessage)
{
    RtpsReader body = submessage.Reader();
    const std::uint64_t seconds = body.U32();
    return seconds << 32 | body.U32();
}

// True if a sample that ends something ends the sender itself, or an endpoint of its own.
bool EndsItsOwn(const Delivery &delivery, const GuidPrefix &sender)
{
    return (delivery.KeyHash.empty() || IsKeyOf(delivery.Writer, sender, delivery.KeyHash)) &&
           (!delivery.HasKeyPayload || CheckKey(delivery.Writer, sender, delivery.Payload));
}

// The endpoint or participant that a sound sample ends by a key alone; 0: none.
EntityId EndedBy(const Delivery &delivery)
{
    EntityId subject = delivery.KeyHash.empty() ? 0 : EntityOf(delivery.KeyHash);
    if (subject == 0 && delivery.HasKeyPayload)
    {
        VisitParameters(delivery.Payload,
                        [&subject](const ListParameter &parameter)
                        {
                            if (parameter.Id == Parameters::EndpointGuid && parameter.Value.size() == 16)
                            {
                                subject = EntityOf(parameter.Value);
                            }
                        });
    }
    return subject;
}

}  // namespace

bool RtpsGuard::Admit(std::span<std::uint8_t> datagram, const HostAddress &from, TimePoint now,
                      const Deliver &deliver, Origin origin)
{
    if (!HasRtpsHeader(datagram))
    {
        return IsWakeUpOfCycloneDds(datagram);
    }
    Passage passage;
    passage.Datagram = datagram;
    std::copy_n(datagram.begin(), RtpsHeaderSize, passage.Header.begin());
    passage.Sender = SenderOf(datagram);
    passage.From = from;
    passage.Whence = origin;
    passage.Now = now;
    std::span<std::uint8_t> left;
    {
        const std::lock_guard lock(_mutex);
        left = Filter(passage);
    }
    for (auto &message : passage.Whole)
    {
        passage.Honest = Admit(message, from, now, deliver, origin) && passage.Honest;
    }
    if (!left.empty())
    {
        deliver(left);
    }
    return passage.Honest;
}

std::span<std::uint8_t> RtpsGuard::Filter(Passage &passage)
{
    auto rest = passage.Datagram.subspan(RtpsHeaderSize);
    auto end = passage.Datagram.size();
    while (!rest.empty())
    {
        const std::size_t at = passage.Datagram.size() - rest.size();
        const auto submessage = TakeSubmessage(rest);
        if (!submessage)
        {
            passage.Honest = false;
            return {};
        }
        if (submessage->Kind == SubmessageKind::Statistics && rest.empty())
        {
            end = at;
            break;
        }
        switch (Judge(*submessage, passage))
        {
            case Verdict::Pass:
                break;
            case Verdict::Refuse:
                passage.Honest = false;
                Blank(*submessage);
                break;
            case Verdict::Forbid:
                passage.Honest = false;
                MakeGap(*submessage);
                break;
            case Verdict::Ignore:
                Blank(*submessage);
                break;
            case Verdict::Drop:
                passage.Honest = false;
                return {};
        }
    }
    if (passage.Whence == Origin::Network)
    {
        _goodbyes->Heard(passage.Sender, passage.Now);
        if (IsCounted(passage))
        {
            _ledger->Came(passage.Sender, passage.Datagram.size());
        }
    }
    if (!passage.Useful)
    {
        return {};
    }
    if (_mode != Mode::Full && passage.Honest)
    {
        _peers.Hears(passage.Sender, passage.Now);
    }
    return passage.Datagram.first(end);
}

RtpsGuard::Verdict RtpsGuard::Judge(const Submessage &submessage, Passage &passage)
{
    if (IsDelivery(submessage.Kind))
    {
        const auto delivery = CheckDelivery(submessage);
        if (!delivery)
        {
            return Verdict::Drop;
        }
        // Data for several participants at once is from builtin endpoints, whose entity ids are the same
        // everywhere.
        return IsForOthers(passage) ? Verdict::Ignore : JudgeDelivery(submessage, *delivery, passage);
    }
    switch (submessage.Kind)
    {
        case SubmessageKind::Pad:
            return Verdict::Pass;
        case SubmessageKind::InfoTimestamp:
            passage.Stamp = (submessage.Flags & InvalidateFlag) != 0 ? 0 : StampOf(submessage);
            return (submessage.Flags & InvalidateFlag) != 0 || HasSize(submessage, 8) ? Verdict::Pass
                                                                                      : Verdict::Drop;
        case SubmessageKind::InfoSource:
            // Cyclone DDS puts submessages of all participants of a process into one message. The sender
            // named here is as trustworthy as the one in the header.
            if (!PutSource(submessage, passage.Header))
            {
                return Verdict::Drop;
            }
            passage.Sender = SenderOf(passage.Header);
            passage.Stamp = 0;
            return Verdict::Pass;
        case SubmessageKind::InfoDestination:
            if (!HasSize(submessage, passage.Destination.size()))
            {
                return Verdict::Drop;
            }
            passage.Destination = PrefixOf(submessage.Body());
            if (passage.Destination == _own)
            {
                _replies.OnAddressed(passage.Sender);
            }
            return Verdict::Pass;
        default:
            // Receivers skip unknown kinds (8.3.4.1). INFO_REPLY, which redirects answers, is one of them: no
            // vendor here sends it. Those of DDS Security are, too.
            return submessage.Kind == SubmessageKind::Statistics ? Verdict::Drop : Verdict::Ignore;
    }
}

bool RtpsGuard::IsForOthers(const Passage &passage) const
{
    return passage.Destination != GuidPrefix{} && _own != GuidPrefix{} && passage.Destination != _own;
}

RtpsGuard::Verdict RtpsGuard::JudgeDelivery(const Submessage &submessage, const Delivery &delivery,
                                            Passage &passage)
{
    const bool isSample =
        submessage.Kind == SubmessageKind::Data || submessage.Kind == SubmessageKind::DataFrag;
    if (IsReplayed(delivery, passage))
    {
        return Verdict::Ignore;
    }
    if (_vendor == Vendor::FastDds)
    {
        if (auto end = WithKeyHash(passage.Header, passage.Destination, submessage, delivery); !end.empty())
        {
            passage.Whole.push_back(std::move(end));
            return Verdict::Ignore;
        }
    }
    auto verdict = Verdict::Pass;
    if (IsBuiltin(delivery.Writer) && !IsKnownBuiltin(delivery.Writer))
    {
        verdict = Verdict::Ignore;
    }
    else if (_mode == Mode::Full && IsBuiltin(delivery.Writer) && !IsItsOwn(submessage, delivery, passage))
    {
        verdict = Verdict::Refuse;
    }
    else if (IsBuiltin(delivery.Writer) && isSample)
    {
        verdict = JudgeBuiltinSample(submessage, delivery, passage);
    }
    const auto goesOn = [&verdict] { return verdict == Verdict::Pass || verdict == Verdict::Forbid; };
    const auto also = [&verdict](Verdict other) { verdict = other == Verdict::Pass ? verdict : other; };
    if (goesOn() && _mode == Mode::Full)
    {
        also(Compare(submessage, delivery, passage));
    }
    if (goesOn() && _vendor == Vendor::FastDds)
    {
        also(CutAbsent(submessage, delivery, passage));
    }
    if (verdict == Verdict::Pass && passage.Whence == Origin::Network && IsCounted(passage))
    {
        NoteVoice(submessage, delivery, passage);
    }
    passage.Useful = passage.Useful || goesOn();
    return verdict;
}

RtpsGuard::Verdict RtpsGuard::JudgeBuiltinSample(const Submessage &submessage, const Delivery &delivery,
                                                 Passage &passage)
{
    if (submessage.Kind == SubmessageKind::DataFrag)
    {
        auto whole = _fragments.Add(passage.Header, delivery, passage.Destination);
        if (!whole.empty())
        {
            passage.Whole.push_back(std::move(whole));
        }
        return Verdict::Ignore;
    }
    if (!EndsItsOwn(delivery, passage.Sender))
    {
        return Verdict::Drop;
    }
    if (delivery.HasKeyPayload || delivery.Payload.empty())
    {
        NoteEnd(delivery, EndedBy(delivery), passage);
        return Verdict::Pass;
    }
    const auto announcement = CheckDiscovery(delivery.Writer, passage.Sender, delivery.Payload,
                                             passage.Whence == Origin::Card ? Lease::OfCard : Lease::Bounded);
    if (!announcement)
    {
        return Verdict::Drop;
    }
    if (!delivery.Alive)
    {
        NoteEnd(delivery, announcement->Subject, passage);
        return Verdict::Pass;
    }
    if (delivery.Writer == ParticipantWriter)
    {
        return JudgeParticipant(*announcement, passage);
    }
    const bool isEndpoint = delivery.Writer == PublicationsWriter || delivery.Writer == SubscriptionsWriter;
    return _mode == Mode::Full && isEndpoint && _peers.Hears(passage.Sender, passage.Now)
               ? JudgeEndpoint(*announcement, delivery.Writer, passage)
               : Verdict::Pass;
}

RtpsGuard::Verdict RtpsGuard::JudgeEndpoint(const Announcement &announcement, EntityId writer,
                                            const Passage &passage)
{
    const auto answer = _authority ? _authority->OfEndpoint(passage.Sender, writer, announcement, passage.Now)
                                   : AuthorityCheck::Answer::Allowed;
    if (answer != AuthorityCheck::Answer::Allowed)
    {
        return answer == AuthorityCheck::Answer::Forbidden ? Verdict::Forbid : Verdict::Ignore;
    }
    if ((IsCounted(passage) &&
         !_ledger->HasEndpoint(passage.Sender, announcement.Subject, announcement.Places, passage.Now)) ||
        !_peers.EndpointAnnounced(passage.Sender, announcement.Subject, announcement.Digest,
                                  announcement.IsBestEffort))
    {
        return Verdict::Refuse;
    }
    return Verdict::Pass;
}

// A sound submessage of a participant has passed.
void RtpsGuard::NoteVoice(const Submessage &submessage, const Delivery &delivery, const Passage &passage)
{
    if (!IsBuiltin(delivery.Writer))
    {
        if (_peers.SpeaksFrom(passage.Sender, passage.From))
        {
            NoteSpoken(passage.Sender);
        }
    }
    else if (submessage.Kind == SubmessageKind::AckNack && delivery.First > 1 &&
             (delivery.Writer == PublicationsWriter || delivery.Writer == SubscriptionsWriter))
    {
        _ledger->Listens(passage.Sender);
    }
}

void RtpsGuard::NoteSpoken(const GuidPrefix &peer)
{
    if (_ledger->Spoke(peer) && _observer != nullptr)
    {
        _observer->Spoke(peer);
    }
}

void RtpsGuard::NoteEnd(const Delivery &delivery, EntityId subject, const Passage &passage)
{
    if (delivery.Writer == ParticipantWriter)
    {
        NoteGoodbye(passage);
    }
    else if (_mode == Mode::Full && delivery.Writer != LivelinessWriter)
    {
        _peers.EndpointGone(passage.Sender, subject);
        _ledger->EndpointGone(passage.Sender, subject);
    }
}

void RtpsGuard::NoteGoodbye(const Passage &passage)
{
    _replies.OnGone(passage.Sender);
    _ledger->Left(passage.Sender);
    passage.Whence == Origin::Card ? _peers.Ended(passage.Sender) : _peers.EndpointsGone(passage.Sender);
    if (passage.Whence != Origin::Network)
    {
        return;
    }
    // Anybody can say goodbye for participants that never were.
    if (_peers.LastHeard(passage.Sender))
    {
        _goodbyes->Note(passage.Sender, passage.Now);
    }
    if (_observer != nullptr)
    {
        _observer->Gone(passage.Sender);
    }
}

RtpsGuard::Verdict RtpsGuard::JudgeParticipant(const Announcement &announcement, const Passage &passage)
{
    if (_goodbyes->Has(passage.Sender, passage.Now))
    {
        return Verdict::Ignore;
    }
    const auto answer = _authority ? _authority->OfParticipant(passage.Sender, announcement, passage.Now)
                                   : AuthorityCheck::Answer::Allowed;
    if (answer != AuthorityCheck::Answer::Allowed)
    {
        return answer == AuthorityCheck::Answer::Forbidden ? Verdict::Refuse : Verdict::Ignore;
    }
    const bool isFromNetwork = passage.Whence == Origin::Network && passage.Sender != _own;
    if (_observer != nullptr && isFromNetwork)
    {
        if (announcement.HasCard)
        {
            _observer->Announced(passage.Sender, true);
            _peers.Hears(passage.Sender, passage.Now);
            return Verdict::Ignore;
        }
        if (_observer->IsReplayed(passage.Sender))
        {
            return Verdict::Refuse;  // a participant does not lose its card
        }
    }
    // A card has come from a participant that goes on (Meeting).
    if (isFromNetwork && !_goodbyes->Heard(passage.Sender, passage.Now))
    {
        return Verdict::Ignore;
    }
    const auto coming =
        IsCounted(passage)
            ? _ledger->Comes(passage.Sender, passage.From,
                             passage.Whence == Origin::Card ? passage.Datagram.size() : 0, passage.Now)
            : Ledger::Coming::Known;
    if (coming == Ledger::Coming::Refused)
    {
        return Verdict::Refuse;
    }
    // In the other mode participants are only counted: addresses come another way.
    if (!_peers.Announced(passage.Sender, _mode == Mode::Full ? announcement.Digest : 0, passage.Now))
    {
        if (coming == Ledger::Coming::New)
        {
            _ledger->Left(passage.Sender);
        }
        return Verdict::Refuse;
    }
    _ledger->SetPlaces(passage.Sender, announcement.Places);
    // Its certificate was proven. One that only reads would never speak.
    if (_authority)
    {
        NoteSpoken(passage.Sender);
    }
    _peers.IsAt(passage.Sender, announcement.Hosts, passage.From);
    if (_mode == Mode::Full)
    {
        _peers.SetListensToGroup(passage.Sender, announcement.ListensToGroup);
    }
    if (isFromNetwork)
    {
        if (_observer != nullptr)
        {
            _observer->Announced(passage.Sender, false);
        }
        ++_announcementsHeard;
        if (_replies.OnAnnouncement(passage.Sender, passage.Now))
        {
            _replyDue = true;
        }
    }
    return Verdict::Pass;
}

bool RtpsGuard::IsReplayed(const Delivery &delivery, const Passage &passage) const
{
    return _observer != nullptr && passage.Whence == Origin::Network &&
           (delivery.Writer == PublicationsWriter || delivery.Writer == SubscriptionsWriter) &&
           _observer->IsReplayed(passage.Sender);
}

bool RtpsGuard::IsKnownAt(std::span<const std::uint8_t> cardMessage, const HostAddress &from)
{
    const GuidPrefix peer = SenderOf(cardMessage);
    _ledger->Came(peer, cardMessage.size());
    const std::lock_guard lock(_mutex);
    return _peers.LastHeard(peer).has_value() && _peers.SpeaksFrom(peer, from);
}

std::optional<RtpsGuard::TimePoint> RtpsGuard::LastHeard(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    return _peers.LastHeard(peer);
}

bool RtpsGuard::GroupReaches(const HostAddress &host, TimePoint since)
{
    const std::lock_guard lock(_mutex);
    return _peers.GroupReaches(host, since);
}

}  // namespace Rabit::Rtps
