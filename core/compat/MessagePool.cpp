#include <rabit/message_pool.h>

#include <algorithm>
#include <stdexcept>

namespace Rabit
{

MessagePool::MessagePool(RabitMessage *prototype, int poolSize)
{
    if (prototype == nullptr)
    {
        throw std::invalid_argument("a message pool needs a prototype");
    }
    _free = std::max(1, poolSize);
    _entries.resize(static_cast<std::size_t>(_free));
    for (Entry &entry : _entries)
    {
        entry.Message = prototype->Clone();
    }
}

int MessagePool::GetNumberOfFreeMessages()
{
    return _free;
}

int MessagePool::GetNumberOfCheckedOutMessages()
{
    return GetPoolSize() - _free;
}

int MessagePool::GetPoolSize()
{
    return static_cast<int>(_entries.size());
}

RabitMessage *MessagePool::CheckOutMessage()
{
    const auto entry = std::find_if(_entries.begin(), _entries.end(),
                                    [](const Entry &candidate) { return !candidate.CheckedOut; });
    if (entry == _entries.end())
    {
        return nullptr;
    }
    entry->CheckedOut = true;
    --_free;
    return entry->Message.get();
}

int MessagePool::CheckInMessage(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        return 0;
    }
    msg->Clear();
    const auto entry = std::find_if(_entries.begin(), _entries.end(),
                                    [&](const Entry &candidate) { return candidate.Message.get() == msg; });
    if (entry == _entries.end())
    {
        return 2;
    }
    if (!entry->CheckedOut)
    {
        return 1;
    }
    entry->CheckedOut = false;
    ++_free;
    return 0;
}

int MessagePool::findNumberOfFreeMessages()
{
    return static_cast<int>(std::count_if(_entries.begin(), _entries.end(),
                                          [](const Entry &entry) { return !entry.CheckedOut; }));
}

}  // namespace Rabit
