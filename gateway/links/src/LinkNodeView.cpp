// The views of a LinkNode for the scheduler and for reports.
#include <rabit/gateway/links/LinkNode.h>

#include "LinkContext.h"
#include "LinkPeer.h"

#include <algorithm>
#include <sstream>

namespace Rabit
{

void LinkNode::Advance(LinkTime now)
{
    ServeRooms(now);
    for (const auto &[name, peer] : _peers)
    {
        peer->Advance(now);
    }
}

void LinkNode::VisitStreams(std::size_t most, LinkTime now,
                            const std::function<void(const LinkStream &)> &visit) const
{
    for (const auto &[name, peer] : _peers)
    {
        if (const std::size_t bytes = peer->UrgentBytes(now))
        {
            visit({.Destination = name, .Queue = {}, .Bytes = bytes});
        }
        for (const auto &[queue, sender] : peer->AllSenders())
        {
            if (const std::size_t bytes = peer->DataBytes(*sender, most, now))
            {
                visit({.Destination = name, .Queue = queue, .Bytes = bytes});
            }
        }
    }
}

bool LinkNode::SendOne(std::string_view destination, std::string_view queue, std::size_t most, LinkTime now)
{
    LinkPeer *peer = FindPeer(destination);
    if (peer == nullptr || queue.empty())
    {
        return peer != nullptr && peer->SendUrgent(now);
    }
    LinkSender *sender = peer->FindSender(queue);
    const std::size_t overhead = _context->Settings.AirOverhead;
    return sender != nullptr &&
           peer->SendData(
               *sender, std::min(_context->Settings.MaxDatagram, most > overhead ? most - overhead : 0), now);
}

LinkNodeCounters LinkNode::Counters() const
{
    return _context->Counters;
}

void LinkNode::VisitSenders(
    const std::function<void(std::string_view, std::string_view, const LinkSenderCounters &)> &visit) const
{
    for (const auto &[name, peer] : _peers)
    {
        for (const auto &[queue, sender] : peer->AllSenders())
        {
            visit(name, queue, sender->Counters());
        }
    }
}

void LinkNode::VisitReceivers(
    const std::function<void(std::string_view, std::string_view, const LinkReceiverCounters &)> &visit) const
{
    for (const auto &[name, peer] : _peers)
    {
        for (const auto &[queue, receiver] : peer->AllReceivers())
        {
            visit(name, queue, receiver->Counters());
        }
    }
}

void LinkNode::VisitPaths(
    const std::function<void(std::string_view node, const LinkPathState &)> &visit) const
{
    for (const auto &[name, peer] : _peers)
    {
        const PathControl &path = peer->Path();
        if (!peer->AllSenders().empty())
        {
            visit(name, {.RoundTrip = path.Times().Smoothed(),
                         .QueueingDelay = path.QueueingDelay(),
                         .Window = path.Window(),
                         .InFlight = path.InFlight(),
                         .DeliveryRate = path.DeliveryRate(),
                         .LossRate = path.LossRate()});
        }
    }
}

void LinkNode::VisitUnanswered(LinkTime now, const std::function<void(std::string_view node)> &visit) const
{
    for (const auto &[name, peer] : _peers)
    {
        if (peer->IsUnansweredAt(now))
        {
            visit(name);
        }
    }
}

void LinkNode::ProbeNow(std::string_view node, LinkTime now)
{
    if (LinkPeer *const peer = FindPeer(node))
    {
        peer->ProbeNow(now);
    }
}

void LinkNode::PathChanged(std::string_view node, LinkTime now)
{
    if (LinkPeer *const peer = FindPeer(node))
    {
        peer->PathChanged(now);
    }
}

LinkTime LinkNode::ShortestRoundTrip(std::string_view node) const
{
    const auto peer = _peers.find(node);
    const bool isKnown = peer != _peers.end() && !peer->second->AllSenders().empty();
    return isKnown ? peer->second->Path().Shortest() : LinkTime(0);
}

std::string LinkNode::Describe() const
{
    std::ostringstream out;
    out << "node " << Name() << ": life " << Incarnation() << " next id " << _nextId << '\n';
    for (const auto &[name, peer] : _peers)
    {
        out << peer->Describe();
    }
    return out.str();
}

}  // namespace Rabit
