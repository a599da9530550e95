#include <rabit/RabitQueueReceipt.h>

#include <ostream>
#include <stdexcept>
#include <utility>

namespace Rabit
{
namespace
{

std::uint32_t &CountOf(RabitQueueReceipt::Counts &counts, QueueOutcome outcome)
{
    switch (outcome)
    {
        case QueueOutcome::Delivered:
            return counts.Delivered;
        case QueueOutcome::Expired:
            return counts.Expired;
        case QueueOutcome::InDoubt:
            return counts.InDoubt;
        case QueueOutcome::Refused:
            return counts.Refused;
        case QueueOutcome::Pending:
            break;
    }
    throw std::invalid_argument("pending is not an outcome that a receipt can be settled with");
}

}  // namespace

QueueOutcome RabitQueueReceipt::Outcome() const
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    const Counts &counts = _counts;
    if (counts.Pending > 0 || _holds > 0)
    {
        return QueueOutcome::Pending;
    }
    if (counts.InDoubt > 0)
    {
        return QueueOutcome::InDoubt;
    }
    if (counts.Expired > 0)
    {
        return QueueOutcome::Expired;
    }
    if (counts.Refused > 0)
    {
        return QueueOutcome::Refused;
    }
    return counts.Delivered > 0 ? QueueOutcome::Delivered : QueueOutcome::Pending;
}

RabitQueueReceipt::Counts RabitQueueReceipt::GetCounts() const
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    return _counts;
}

std::string RabitQueueReceipt::RefusalReason() const
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    return _refusalReason;
}

RabitConnection RabitQueueReceipt::ConnectOutcomeKnown(RabitHandler handler)
{
    return _known.Connect(std::move(handler));
}

void RabitQueueReceipt::Begin(std::uint32_t messages)
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    _counts.Pending += messages;
}

void RabitQueueReceipt::Settle(QueueOutcome outcome)
{
    End(outcome, true);
}

void RabitQueueReceipt::Refuse(std::string reason)
{
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        _refusalReason = std::move(reason);
    }
    End(QueueOutcome::Refused, false);
}

void RabitQueueReceipt::End(QueueOutcome outcome, bool isNews)
{
    RabitEvent::Handlers handlers;
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        std::uint32_t &count = CountOf(_counts, outcome);
        if (_counts.Pending == 0)
        {
            throw std::logic_error("a receipt was settled more often than messages were begun");
        }
        ++count;
        --_counts.Pending;
        _news = _news || isNews;
        handlers = HandlersIfKnown();
    }
    handlers.Call();
}

void RabitQueueReceipt::Hold()
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    ++_holds;
}

void RabitQueueReceipt::Release()
{
    RabitEvent::Handlers handlers;
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        if (_holds == 0)
        {
            throw std::logic_error("a receipt was released more often than it was held");
        }
        --_holds;
        handlers = HandlersIfKnown();
    }
    handlers.Call();
}

// The caller holds the mutex.
RabitEvent::Handlers RabitQueueReceipt::HandlersIfKnown()
{
    const bool isKnown = _holds == 0 && _counts.Pending == 0;
    return isKnown && std::exchange(_news, false) ? _known.Snapshot() : RabitEvent::Handlers();
}

const char *ToString(QueueOutcome outcome)
{
    switch (outcome)
    {
        case QueueOutcome::Pending:
            return "pending";
        case QueueOutcome::Delivered:
            return "delivered";
        case QueueOutcome::Expired:
            return "expired";
        case QueueOutcome::InDoubt:
            return "in doubt";
        case QueueOutcome::Refused:
            return "refused";
    }
    return "unknown";
}

std::ostream &operator<<(std::ostream &stream, QueueOutcome outcome)
{
    return stream << ToString(outcome);
}

}  // namespace Rabit
