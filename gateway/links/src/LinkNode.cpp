#include <rabit/gateway/links/LinkNode.h>

#include <rabit/gateway/links/LinkCheck.h>
#include "LinkContext.h"
#include "LinkPeer.h"
#include "LinkValidation.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

LinkNode::LinkNode(const LinkSettings &settings, LinkOutput &output, LocalQueues &queues,
                   IncarnationSource &incarnations)
    : _incarnations(incarnations)
{
    RequireValid(settings);
    _context = std::make_unique<LinkContext>(settings, output, queues, incarnations.Above(0));
}

LinkNode::~LinkNode() = default;

const std::string &LinkNode::Name() const
{
    return _context->Settings.Node;
}

std::uint64_t LinkNode::Incarnation() const
{
    return _context->Incarnation;
}

bool LinkNode::NameInUseElsewhere() const
{
    return _context->Counters.Raises >= _context->Settings.AlarmAfterRaises;
}

LinkPeer *LinkNode::FindPeer(std::string_view name) const
{
    const auto found = _peers.find(name);
    return found == _peers.end() ? nullptr : found->second.get();
}

LinkPeer *LinkNode::FindOrAddPeer(std::string_view name, LinkTime now)
{
    if (LinkPeer *peer = FindPeer(name))
    {
        return peer;
    }
    if (_peers.size() >= _context->Settings.MaxPeers && !ForgetOne(now))
    {
        return nullptr;
    }
    auto peer = std::make_unique<LinkPeer>(*_context, std::string(name), now);
    return _peers.emplace(std::string(name), std::move(peer)).first->second.get();
}

// Forgets a peer without links first, since it loses nothing; then the peer that has been silent for longest.
bool LinkNode::ForgetOne(LinkTime now)
{
    const auto rank = [](const Peers::value_type &entry)
    { return std::pair(entry.second->HasLinks(), entry.second->HeardAt()); };
    auto first = _peers.end();
    for (auto peer = _peers.begin(); peer != _peers.end(); ++peer)
    {
        const bool possible =
            peer->second->MayBeForgotten() && (!peer->second->HasLinks() || peer->second->IsUnheardAt(now));
        if (possible && (first == _peers.end() || rank(*peer) < rank(*first)))
        {
            first = peer;
        }
    }
    if (first == _peers.end())
    {
        return false;
    }
    Forget(first);
    return true;
}

// If the peer comes back, this node has a new incarnation for it. So no forgotten stream or session is
// continued: neither this node nor rule R3 could tell it from a new one.
void LinkNode::Forget(Peers::iterator peer)
{
    _context->Incarnation += peer->second->HasLinks() ? 1 : 0;
    ++_context->Counters.Forgotten;
    _peers.erase(peer);
}

bool LinkNode::Forget(std::string_view node)
{
    const auto found = _peers.find(node);
    if (found == _peers.end())
    {
        return true;
    }
    if (!found->second->MayBeForgotten())
    {
        return false;
    }
    Forget(found);
    return true;
}

bool LinkNode::HasPending(std::string_view node) const
{
    const LinkPeer *peer = FindPeer(node);
    return peer != nullptr && !peer->MayBeForgotten();
}

std::uint64_t LinkNode::IncarnationTo(std::string_view node) const
{
    const LinkPeer *peer = FindPeer(node);
    return peer == nullptr ? _context->Incarnation : peer->OwnLife();
}

bool LinkNode::IsPossiblePeer(std::string_view name) const
{
    return IsPossibleName(name) && name != _context->Settings.Node;
}

LinkRefusal LinkNode::FindOrAddSender(std::string_view destination, std::string_view queue,
                                      const LinkOptions *options, LinkTime now, LinkPeer *&peer,
                                      LinkSender *&sender)
{
    peer = FindPeer(destination);
    sender = peer != nullptr ? peer->FindSender(queue) : nullptr;
    if (sender != nullptr)
    {
        return LinkRefusal::None;
    }
    if (!IsPossiblePeer(destination) || !IsPossibleName(queue))
    {
        return LinkRefusal::BadName;
    }
    peer = FindOrAddPeer(destination, now);
    if (peer == nullptr)
    {
        return LinkRefusal::TooManyPeers;
    }
    if (peer->AllSenders().size() >= _context->Settings.MaxLinksPerPeer)
    {
        return LinkRefusal::TooManyLinks;
    }
    sender = &peer->AddSender(queue,
                              options != nullptr ? *options : _context->Output.OptionsOf(destination, queue));
    return LinkRefusal::None;
}

LinkRefusal LinkNode::Configure(std::string_view destination, std::string_view queue,
                                const LinkOptions &options, LinkTime now)
{
    RequireValid(options);
    LinkPeer *peer = nullptr;
    LinkSender *sender = nullptr;
    return FindOrAddSender(destination, queue, &options, now, peer, sender);
}

LinkEnqueued LinkNode::Enqueue(std::string_view destination, std::string_view queue, std::string_view type,
                               LinkPayload payload, LinkTime now)
{
    if (!IsPossibleName(type))
    {
        ++_context->Counters.RefusedBadName;
        return {.Refusal = LinkRefusal::BadName};
    }
    LinkPeer *peer = nullptr;
    LinkSender *sender = nullptr;
    LinkRefusal refusal = FindOrAddSender(destination, queue, nullptr, now, peer, sender);
    if (refusal != LinkRefusal::None)
    {
        ++(refusal == LinkRefusal::BadName ? _context->Counters.RefusedBadName
                                           : _context->Counters.RefusedTooMany);
        return {.Refusal = refusal};
    }
    auto known = _types.find(type);
    if (known == _types.end())
    {
        known = _types.emplace(type).first;
    }
    refusal = sender->Enqueue(_nextId, *known, std::move(payload), now);
    if (refusal != LinkRefusal::None)
    {
        return {.Refusal = refusal};
    }
    peer->OnEnqueued(now);
    return {.Refusal = LinkRefusal::None, .Id = _nextId++, .Due = peer->NextDue()};
}

// Rules R1 and S6, and the rule for hellos: a peer that knows a higher incarnation of this node than the
// present one makes this node take a yet higher one. Nothing received or sent in the old incarnation is
// continued.
void LinkNode::HeardOfMyself(const LinkPeer *from, std::uint64_t incarnation, LinkTime now)
{
    if (incarnation <= (from == nullptr ? _context->Incarnation : from->OwnLife()))
    {
        return;
    }
    if ((incarnation >> 32) > LinkLargestClaim)
    {
        ++_context->Counters.FalseClaims;
        return;
    }
    if (now < _mayRaiseAt)
    {
        ++_context->Counters.RaisesPutOff;
        return;
    }
    _mayRaiseAt = now + _context->Settings.RaiseGap;
    _context->Incarnation = _incarnations.Above(std::max(incarnation, _context->Incarnation));
    ++_context->Counters.Raises;
    for (const auto &[name, peer] : _peers)
    {
        peer->OnOwnRaise(now);
    }
}

// True if the frame is well-formed and for this node. Changes only the frame and counters.
bool LinkNode::Accepts(LinkFrame &frame, const LinkPeer *peer, LinkTime now)
{
    if (!IsWellFormed(frame) || frame.Source == _context->Settings.Node)
    {
        ++_context->Counters.Malformed;
        return false;
    }
    if (frame.Short)
    {
        if (peer == nullptr || !peer->Expand(frame, now))
        {
            OnUnknownShort(frame, now);
            return false;
        }
    }
    else if (frame.Check != LinkCheck::OfName(_context->Settings.Node))
    {
        ++_context->Counters.NotForUs;
        return false;
    }
    if (peer != nullptr && !peer->AreAcksPossible(frame))
    {
        ++_context->Counters.Malformed;
        return false;
    }
    return true;
}

// The sender of a short frame wrongly assumes that this node knows it. A hello, which is long, corrects that.
void LinkNode::OnUnknownShort(const LinkFrame &frame, LinkTime now)
{
    ++_context->Counters.UnknownShort;
    LinkPeer *peer = FindOrAddPeer(frame.Source, now);
    if (peer != nullptr)
    {
        peer->HelloSoon(now);
    }
}

bool LinkNode::OnFrame(LinkFrame &frame, LinkTime now)
{
    LinkPeer *peer = FindPeer(frame.Source);
    if (!Accepts(frame, peer, now))
    {
        return false;
    }
    HeardOfMyself(peer, frame.ReceiverLife, now);  // rules R1 and S6
    peer = peer != nullptr ? peer : FindOrAddPeer(frame.Source, now);
    if (peer == nullptr)
    {
        ++_context->Counters.TooManyPeers;
        return false;
    }
    peer->OnFrame(frame, now);
    return true;
}

void LinkNode::HeardOf(std::string_view node, std::uint64_t incarnation, LinkTime now)
{
    LinkPeer *peer = FindPeer(node);
    if (peer != nullptr && peer->Incarnation() != 0 && incarnation > peer->Incarnation() &&
        (incarnation >> 32) <= LinkLargestClaim)
    {
        peer->HeardOf(incarnation, now);
    }
}

void LinkNode::OnRoom(std::string_view queue)
{
    auto turn = _turns.find(queue);
    if (turn == _turns.end())
    {
        turn = _turns.emplace(std::string(queue), Turn()).first;
    }
    turn->second.RoomCame = true;
    _roomCame = true;
}

// The links that wait for a queue with room take turns, a message each.
void LinkNode::ServeRooms(LinkTime now)
{
    if (!std::exchange(_roomCame, false))
    {
        return;
    }
    for (auto &[queue, turn] : _turns)
    {
        if (!std::exchange(turn.RoomCame, false))
        {
            continue;
        }
        _waiting.clear();
        for (const auto &[name, peer] : _peers)
        {
            LinkReceiver *receiver = peer->FindReceiver(queue);
            if (receiver != nullptr && receiver->IsWaiting())
            {
                _waiting.emplace_back(&name, receiver);
            }
        }
        for (const auto &[name, receiver] : _waiting)
        {
            receiver->OnRoom(_waiting.size(), now);
        }
        std::stable_partition(_waiting.begin(), _waiting.end(),
                              [&last = turn.Last](const auto &waiting) { return *waiting.first > last; });
        for (bool any = true; any;)
        {
            any = false;
            for (const auto &[name, receiver] : _waiting)
            {
                if (receiver->TakeTurn(now))
                {
                    turn.Last = *name;
                    any = true;
                }
            }
        }
    }
}

void LinkNode::Prepared(std::string_view source, std::string_view queue, std::uint64_t senderLife,
                        std::uint64_t number, std::shared_ptr<void> prepared, LinkTime now)
{
    const LinkPeer *peer = FindPeer(source);
    LinkReceiver *receiver = peer == nullptr ? nullptr : peer->FindReceiver(queue);
    if (receiver != nullptr)
    {
        receiver->Prepared(senderLife, number, std::move(prepared), now);
    }
}

void LinkNode::Run(LinkTime now)
{
    ServeRooms(now);
    for (const auto &[name, peer] : _peers)
    {
        peer->Run(now);
    }
}

LinkTime LinkNode::NextDue() const
{
    LinkTime due = _roomCame ? LinkTime(0) : LinkNever;
    for (const auto &[name, peer] : _peers)
    {
        due = std::min(due, peer->NextDue());
    }
    return due;
}

void LinkNode::Close()
{
    for (const auto &[name, peer] : _peers)
    {
        for (const auto &[queue, sender] : peer->AllSenders())
        {
            sender->Close();
        }
    }
}

}  // namespace Rabit
