#pragma once

#include <rabit/RabitMessage.h>

#include <memory>
#include <vector>

namespace Rabit
{

// A fixed number of messages of one type, made once and lent out repeatedly. For programs that must not
// allocate while they run. The pool owns its messages: they must not be used after it is gone. Not
// thread-safe.
class MessagePool
{
public:
    // Fills the pool with clones of the prototype, at least one; the prototype stays the caller's. Throws
    // std::invalid_argument if it is null.
    MessagePool(RabitMessage *prototype, int poolSize);
    MessagePool(const MessagePool &) = delete;
    MessagePool &operator=(const MessagePool &) = delete;

    int GetNumberOfFreeMessages();
    int GetNumberOfCheckedOutMessages();
    int GetPoolSize();

    // Lends a message out; null if none is free.
    RabitMessage *CheckOutMessage();
    // Takes a message back and clears it. Returns 0 on success (also for null); 1 if it is not checked out;
    // 2 if it is not of this pool: it was cleared nevertheless.
    int CheckInMessage(RabitMessage *msg);
    // Counts the free messages one by one.
    int findNumberOfFreeMessages();

private:
    struct Entry
    {
        std::unique_ptr<RabitMessage> Message;
        bool CheckedOut = false;
    };

    std::vector<Entry> _entries;
    int _free = 0;
};

}  // namespace Rabit
