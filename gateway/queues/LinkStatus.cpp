#include "queues/LinkStatus.h"

namespace Rabit::LinkStatus
{

std::vector<Gateway::LinkStatus> Outbound(const LinkNode &links)
{
    std::vector<Gateway::LinkStatus> status;
    links.VisitSenders(
        [&status](std::string_view node, std::string_view queue, const LinkSenderCounters &counters)
        {
            Gateway::LinkStatus &row = status.emplace_back();
            row.node = node;
            row.queue = queue;
            row.outbox = static_cast<std::uint32_t>(counters.Pending);
            row.held_back = counters.HeldBack;
            row.fill = counters.Fill;
            row.accepted = counters.Accepted;
            row.delivered = counters.Delivered;
            row.expired = counters.Expired;
            row.in_doubt = counters.InDoubt;
            row.undeliverable = counters.RefusedThere;
            // A message that no outbox would take is counted as refused_type, with its problem.
            row.refused_full = counters.RefusedFullByCount + counters.RefusedFullByBytes;
            row.resent = counters.PartsResent;
            row.bytes = counters.BytesSent;
        });
    return status;
}

std::vector<Gateway::InboundStatus> Inbound(const LinkNode &links)
{
    std::vector<Gateway::InboundStatus> status;
    links.VisitReceivers(
        [&](std::string_view node, std::string_view queue, const LinkReceiverCounters &counters)
        {
            Gateway::InboundStatus &row = status.emplace_back();
            row.node = node;
            row.queue = queue;
            row.delivered = counters.Delivered;
            row.expired = counters.Skipped;
            row.undeliverable =
                counters.RefusedUnknown + counters.RefusedWrongType + counters.RefusedUndecodable;
            row.held_back = counters.HeldBack;
        });
    return status;
}

}  // namespace Rabit::LinkStatus
