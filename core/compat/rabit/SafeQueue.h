#pragma once

#include <rabit/RabitRing.h>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

namespace Rabit
{

// A bounded first-in-first-out queue for any number of threads. Never blocks for longer than its lock is
// held. Elements are copied or moved under the lock and destroyed outside it.
template <typename T>
class SafeQueue
{
public:
    // At least one element.
    explicit SafeQueue(int maxQueueSize) : _ring(static_cast<std::size_t>(std::max(1, maxQueueSize))) {}
    SafeQueue(const SafeQueue &) = delete;
    SafeQueue &operator=(const SafeQueue &) = delete;

    int GetMaxQueueSize() { return static_cast<int>(_ring.Capacity()); }

    // False when full.
    bool enqueue(T element)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _ring.Push(element);
    }

    // Returns false when empty, and then leaves the target unchanged.
    bool dequeue(T &element)
    {
        std::optional<T> oldest;
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            oldest = _ring.Pop();
        }
        if (!oldest)
        {
            return false;
        }
        element = std::move(*oldest);
        return true;
    }

    void clear()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        const auto removed = _ring.TakeAll();
        lock.unlock();
    }

    int size()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return static_cast<int>(_ring.Size());
    }

    bool empty() { return size() == 0; }

private:
    std::mutex _mutex;
    RabitRing<T> _ring;
};

}  // namespace Rabit
