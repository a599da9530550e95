#pragma once

#include <rabit/RabitEvent.h>

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <mutex>
#include <string>

namespace Rabit
{

// The outcome of a message that was added to a queue with a receipt.
enum class QueueOutcome
{
    Pending,    // it is on its way, or nothing was added with this receipt yet
    Delivered,  // it is in the queue
    Expired,    // its time ran out on the way; it was not delivered and never will be
    InDoubt,    // sender or receiver restarted: it may or may not have been delivered
    Refused     // refused at the call or at the destination; it was not delivered and never will be
};

// Tells the sender of a queue message its outcome. Pass a receipt to AddMessageToQueue, keep it, and ask it
// at any time, or let RabitManager::WakeUpManagerOnOutcome wake the manager.
//
// A message for a local queue has its outcome at once. A message for another node (`node/queue`) gets it
// when that node acknowledges the message, or when it is certain that it never will. A receipt given to
// several calls, or to a call that sends to several nodes (`*/queue`), stands for all of these messages
// together.
//
// AddMessageToQueue returns false for a message that is refused at the call. The receipt counts that message
// as Refused and calls no handler for it: a manager that tries again when it is woken would never sleep.
//
// Threads: all methods may be called from any thread. Lifetime: shared; dropping a receipt drops the answer,
// not the message.
class RabitQueueReceipt
{
public:
    // The number of messages for each outcome.
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

    // Pending while any message is pending. Then Delivered if all were delivered; else InDoubt if any is in
    // doubt, else Expired if any expired, else Refused.
    QueueOutcome Outcome() const;
    Counts GetCounts() const;
    // Why a message was refused at the call, in words: of several, the last one that was. Empty if none was,
    // or if its QueueForwarder tells none.
    std::string RefusalReason() const;

    // Calls the handler whenever no message is pending any more and at least one got its outcome since the
    // handlers were last called. Messages refused at the call do not count. The handler runs with no lock
    // held: for a local queue on the thread of the caller, else on the gateway's thread for handlers. A
    // RabitQuickHandler runs on the thread that learns the outcome, often a network thread. Throws
    // std::invalid_argument if it is empty.
    RabitConnection ConnectOutcomeKnown(RabitHandler handler);

    // The methods below are for the code that delivers: the workspace, a QueueForwarder.
    //
    // Counts `messages` more as pending. Each of them then gets one Settle or one Refuse; these throw
    // std::logic_error if no message is pending.
    void Begin(std::uint32_t messages = 1);
    // One message came to this outcome. Throws std::invalid_argument if the outcome is Pending.
    void Settle(QueueOutcome outcome);
    // One message is refused at the call, for that reason: AddMessageToQueue will return false.
    void Refuse(std::string reason = "");
    // Between Hold and Release the outcome is Pending, and no handler is called. Used while one message
    // goes to several queues, as further Begins may follow.
    void Hold();
    void Release();

private:
    void End(QueueOutcome outcome, bool isNews);
    RabitEvent::Handlers HandlersIfKnown();

    const std::shared_ptr<std::mutex> _mutex = std::make_shared<std::mutex>();
    Counts _counts;
    std::uint32_t _holds = 0;
    bool _news = false;  // a message was settled since the handlers were called
    std::string _refusalReason;
    RabitEvent _known{_mutex};
};

// For logs: `pending`, `delivered`, `expired`, `in doubt`, `refused`.
const char *ToString(QueueOutcome outcome);
std::ostream &operator<<(std::ostream &stream, QueueOutcome outcome);

}  // namespace Rabit
