// The guard compares a submessage with what its sender sent before, and replaces the numbers by which the
// vendor detects repeats.
#include <rabit/base/Fnv1a.h>

#include <algorithm>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/RtpsGuard.h"

namespace Rabit::Rtps
{

namespace
{

// An honest sender repeats a discovery submessage unchanged until it is answered. Only the count changes and,
// in a heartbeat, how far it has come.
PeerVoice::Saying SayingOf(SubmessageKind kind, const Delivery &delivery)
{
    Fnv1a about;
    about.AddNumber(static_cast<std::uint64_t>(kind));
    about.AddNumber(delivery.Writer);
    Fnv1a content;
    content.AddNumber(static_cast<std::uint64_t>(delivery.First));
    if (kind != SubmessageKind::Heartbeat)
    {
        content.AddNumber(static_cast<std::uint64_t>(delivery.Last));
        content.AddNumber(delivery.LastFragment);
    }
    if (kind == SubmessageKind::Data || kind == SubmessageKind::Gap)
    {
        about.AddNumber(static_cast<std::uint64_t>(delivery.First));
        content.AddNumber(delivery.Alive ? 1 : 0);
        content.Add(delivery.KeyHash);
        content.Add(delivery.Payload);
    }
    return {about.Sum(), content.Sum()};
}

void WriteSampleNumber(const Submessage &submessage, std::int64_t number)
{
    WriteSequence(submessage.Body().subspan(NumberInData), number, submessage.LittleEndian);
}

}  // namespace

void RtpsGuard::Sending(std::span<const std::uint8_t> datagram)
{
    const std::lock_guard lock(_mutex);
    if (HasRtpsHeader(datagram))
    {
        _own = SenderOf(datagram);
    }
    GuidPrefix to{};
    // The datagram is our own and therefore sound. It has few submessages.
    VisitSubmessages(datagram,
                     [&](const ConstSubmessage &part)
                     {
                         RtpsReader body = part.Reader();
                         if (part.Kind == SubmessageKind::DataFrag)
                         {
                             _sent.Sent(body);
                         }
                         else if (part.Kind == SubmessageKind::InfoDestination)
                         {
                             to = PrefixOf(part.Body());
                         }
                         else if (part.Kind == SubmessageKind::AckNack)
                         {
                             body.Skip(sizeof(EntityId));
                             const EntityId writer = body.Entity();
                             if (AbsentNumbers *const absent = _peers.Absent(to, writer))
                             {
                                 absent->Acknowledged(body.Sequence());
                             }
                         }
                     });
}

bool RtpsGuard::IsItsOwn(const Submessage &submessage, const Delivery &delivery, const Passage &passage)
{
    const bool announces = delivery.Writer == ParticipantWriter && delivery.Alive;  // it tells addresses
    return announces || passage.Whence == Origin::Card ||  // it was taken or refused as a whole
           submessage.Kind == SubmessageKind::DataFrag ||  // it is checked when whole
           _peers.SpeaksFrom(passage.Sender, passage.From) ||
           _peers.Believes(passage.Sender, passage.From, SayingOf(submessage.Kind, delivery));
}

RtpsGuard::Verdict RtpsGuard::Compare(const Submessage &submessage, const Delivery &delivery,
                                      const Passage &passage)
{
    // The vendor does not use data that comes before the announcement of the participant, or of the writer:
    // no reader would accept it.
    if (!_peers.Hears(passage.Sender, passage.Now))
    {
        if (_observer != nullptr && passage.Whence == Origin::Network && passage.Sender != _own)
        {
            _observer->HeardUnknown(passage.Sender);
        }
        return Verdict::Ignore;
    }
    switch (submessage.Kind)
    {
        case SubmessageKind::Data:
        case SubmessageKind::DataFrag:
        case SubmessageKind::Heartbeat:
            if (!_peers.HasWriter(passage.Sender, delivery.Writer))
            {
                return Verdict::Ignore;
            }
            if (!_peers.Reaches(passage.Sender, delivery.Writer, std::max(delivery.First - 1, delivery.Last),
                                passage.Now))
            {
                return Verdict::Refuse;
            }
            if (submessage.Kind != SubmessageKind::Heartbeat && !IsBuiltin(delivery.Writer))
            {
                ReplaceNumber(submessage, delivery, passage);
            }
            break;
        case SubmessageKind::Gap:
            if (!_peers.HasWriter(passage.Sender, delivery.Writer))
            {
                return Verdict::Ignore;
            }
            if (!_peers.CanKnowOf(passage.Sender, delivery.Writer, delivery.Last))
            {
                return Verdict::Refuse;
            }
            break;
        case SubmessageKind::NackFrag:
            if (_vendor == Vendor::FastDds &&
                !_sent.Has(delivery.Writer, delivery.First, delivery.LastFragment))
            {
                return Verdict::Refuse;
            }
            break;
        default:
            break;
    }
    if (submessage.Kind == SubmessageKind::Data && delivery.Writer == ParticipantWriter)
    {
        ReplaceAnnouncement(submessage, delivery, passage.Sender);
    }
    if (submessage.Kind == SubmessageKind::Heartbeat)
    {
        ReplaceCount(submessage, delivery, passage.Sender);
    }
    return Verdict::Pass;
}

RtpsGuard::Verdict RtpsGuard::CutAbsent(const Submessage &submessage, const Delivery &delivery,
                                        const Passage &passage)
{
    constexpr std::size_t FirstAt = 8;  // 9.4.5.6 and 9.4.5.7: behind two entities
    constexpr std::size_t BaseAt = 16;
    constexpr std::size_t BitsAt = 24;
    const auto at = [&](std::size_t position) { return submessage.Body().subspan(position); };
    // Without an announcement (shared memory) it is not known where the vendor is.
    AbsentNumbers unknown;
    AbsentNumbers *absent = _peers.Absent(passage.Sender, delivery.Writer);
    if (absent == nullptr)
    {
        unknown.Acknowledged(delivery.First);
        absent = &unknown;
    }
    if (submessage.Kind == SubmessageKind::Data)
    {
        absent->Given(delivery.First);
    }
    else if (submessage.Kind == SubmessageKind::Heartbeat)
    {
        WriteSequence(at(FirstAt), absent->FirstOf(delivery.First, _walk, passage.Now),
                      submessage.LittleEndian);
    }
    else if (submessage.Kind == SubmessageKind::Gap)
    {
        const std::int64_t base = RtpsReader(at(BaseAt), submessage.LittleEndian).Sequence();
        const auto part = absent->PartOf({delivery.First, base, delivery.Last}, _walk, passage.Now);
        if (!part)
        {
            return Verdict::Ignore;
        }
        WriteSequence(at(FirstAt), part->First, submessage.LittleEndian);
        if (part->Base < base)
        {
            WriteSequence(at(BaseAt), part->Base, submessage.LittleEndian);
            Write(at(BitsAt).first(4), 0, submessage.LittleEndian);
        }
    }
    return Verdict::Pass;
}

void RtpsGuard::ReplaceNumber(const Submessage &submessage, const Delivery &delivery, const Passage &passage)
{
    const std::int64_t ours =
        _peers.NumberOf(passage.Sender, delivery.Writer, delivery.First, passage.Stamp, passage.Now);
    if (ours != delivery.First)
    {
        WriteSampleNumber(submessage, ours);
    }
}

void RtpsGuard::ReplaceAnnouncement(const Submessage &submessage, const Delivery &delivery,
                                    const GuidPrefix &sender)
{
    WriteSampleNumber(submessage, delivery.Alive ? _peers.AnnouncementOf(sender, delivery.First)
                                                 : _peers.GoodbyeOf(sender, delivery.First));
}

void RtpsGuard::ReplaceCount(const Submessage &submessage, const Delivery &delivery, const GuidPrefix &sender)
{
    const auto bytes = submessage.Body().subspan(delivery.CountAt, 4);
    const std::uint32_t theirs = RtpsReader(bytes, submessage.LittleEndian).U32();
    Write(bytes, _peers.CountOf(sender, delivery.Writer, theirs), submessage.LittleEndian);
}

}  // namespace Rabit::Rtps
