#pragma once

#include <rabit/RabitEvent.h>

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <mutex>

namespace Rabit
{

// What became of a message that was added to a queue with a receipt.
enum class QueueOutcome
{
    Pending,    // it is on its way, or nothing was added with this receipt yet
    Delivered,  // it is in the queue
    Expired,    // its time ran out on the way; it was not delivered and never will be
    InDoubt,    // where it went, or from where, somebody restarted: it may or may not have been delivered
    Refused     // it was not accepted, at the call or over there; it was not delivered and never will be
};

// Tells the sender of a queue message what became of it. Hand one to AddMessageToQueue, keep it, and ask it
// whenever it suits, or have the manager woken with RabitManager::WakeUpManagerOnOutcome.
//
// A message for a local queue has its outcome at once. One for a queue elsewhere (`node/queue`) gets it when
// the other side acknowledged it, or when it is certain that it never will. A receipt given to several calls,
// or to one that sends to several nodes (`*/queue`), stands for all of them together.
//
// Threads: all methods may be called from any thread. Lifetime: shared; dropping a receipt drops the answer,
// not the message.
class RabitQueueReceipt
{
public:
    // How many messages came to which outcome.
    struct Counts
    {
        std::uint32_t Pending = 0;
        std::uint32_t Delivered = 0;
        std::uint32_t Expired = 0;
        std::uint32_t InDoubt = 0;
        std::uint32_t Refused = 0;
    };

    RabitQueueReceipt() = default;
    RabitQueueReceipt(const RabitQueueReceipt &) = delete;
    RabitQueueReceipt &operator=(const RabitQueueReceipt &) = delete;

    // Pending while any message is; then Delivered if all were, else what went wrong: InDoubt if that holds
    // for any, else Expired, else Refused.
    QueueOutcome Outcome() const;
    Counts GetCounts() const;

    // Has the handler called whenever the last pending message gets its outcome: with no lock held, on the
    // thread that learns it (for a local queue the caller's, else often one of the network's), so it must be
    // quick. Throws std::invalid_argument if it is empty.
    RabitConnection ConnectOutcomeKnown(RabitHandler handler);

    // For who delivers (the workspace, a QueueForwarder): `messages` more are on their way; and one of them
    // came to this outcome, which is not Pending (throws std::invalid_argument) and is preceded by a Begin
    // (throws std::logic_error).
    void Begin(std::uint32_t messages = 1);
    void Settle(QueueOutcome outcome);
    // For who hands one message to several: from Hold to Release the outcome is Pending and not known,
    // whatever is settled, because more messages may begin.
    void Hold();
    void Release();

private:
    const std::shared_ptr<std::mutex> _mutex = std::make_shared<std::mutex>();
    Counts _counts;
    std::uint32_t _holds = 0;
    bool _settledWhileHeld = false;
    RabitEvent _known{_mutex};
};

// For logs: `pending`, `delivered`, `expired`, `in doubt`, `refused`.
const char *ToString(QueueOutcome outcome);
std::ostream &operator<<(std::ostream &stream, QueueOutcome outcome);

}  // namespace Rabit
