#include "queues/LinkDriver.h"

// What Gateway/Fleet shows of the links.

namespace Rabit
{

std::vector<Gateway::LinkStatus> LinkDriver::OutboundStatus() const
{
    const std::lock_guard lock(_mutex);
    std::map<LinkRefusals::LinkName, Gateway::LinkStatus> rows;
    _links->VisitSenders(
        [&rows](std::string_view node, std::string_view queue, const LinkSenderCounters &counters)
        {
            Gateway::LinkStatus &row = rows[{std::string(node), std::string(queue)}];
            row.outbox = static_cast<std::uint32_t>(counters.Pending);
            row.accepted = counters.Accepted;
            row.delivered = counters.Delivered;
            row.expired = counters.Expired;
            row.in_doubt = counters.InDoubt;
            row.undeliverable = counters.RefusedThere;
            row.refused_full =
                counters.RefusedFullByCount + counters.RefusedFullByBytes + counters.RefusedTooLarge;
            row.resent = counters.MessagesResent;
        });
    _refusals.Report(rows);
    std::vector<Gateway::LinkStatus> status;
    for (auto &[name, row] : rows)
    {
        row.node = name.first;
        row.queue = name.second;
        status.push_back(row);
    }
    return status;
}

std::vector<Gateway::InboundStatus> LinkDriver::InboundStatus() const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::InboundStatus> status;
    _links->VisitReceivers(
        [this, &status](std::string_view node, std::string_view queue, const LinkReceiverCounters &counters)
        {
            Gateway::InboundStatus row;
            row.node = node;
            row.queue = queue;
            row.delivered = counters.Delivered;
            row.expired = counters.Skipped;
            row.undeliverable =
                counters.RefusedUnknown + counters.RefusedWrongType + counters.RefusedUndecodable;
            row.held_back = Room(queue) == 0;
            status.push_back(row);
        });
    return status;
}

std::vector<Gateway::Problem> LinkDriver::Problems() const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> problems = _refusals.Problems();
    for (const auto &[name, queue] : _accepted)
    {
        if (!queue.Problem().empty())
        {
            Gateway::Problem problem;
            problem.subject = "accept " + name;
            problem.reason = queue.Problem();
            problems.push_back(problem);
        }
    }
    if (!_incarnations.Error().empty())
    {
        Gateway::Problem problem;
        problem.subject = "state_dir " + _config.StateDir;
        problem.reason = _incarnations.Error();
        problems.push_back(problem);
    }
    if (_links->NameInUseElsewhere())
    {
        Gateway::Problem problem;
        problem.subject = "node " + _config.Node;
        problem.reason =
            "the incarnation of this node had to be raised again and again: another live node must have this "
            "name";
        problems.push_back(problem);
    }
    return problems;
}

std::uint64_t LinkDriver::Malformed() const
{
    const std::lock_guard lock(_mutex);
    return _malformed + _links->Counters().Malformed + _links->Counters().NotForUs;
}

}  // namespace Rabit
