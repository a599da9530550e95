#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace Rabit
{

// A bounded first-in-first-out store. Its memory grows with use up to the bound and is then kept, so that a
// queue in its steady state does not allocate. Not thread-safe: the queues guard it with their lock.
template <typename T>
class RabitRing
{
public:
    explicit RabitRing(std::size_t capacity) : _capacity(capacity) {}

    std::size_t Capacity() const { return _capacity; }
    std::size_t Size() const { return _count; }

    // Returns false when full, and then leaves the element unchanged.
    bool Push(T &element)
    {
        if (_count == _capacity)
        {
            return false;
        }
        if (_count == _slots.size())
        {
            Grow();
        }
        std::size_t tail = _head + _count;
        if (tail >= _slots.size())
        {
            tail -= _slots.size();
        }
        _slots[tail].emplace(std::move(element));
        ++_count;
        return true;
    }

    // Takes the oldest element; returns nothing when empty.
    std::optional<T> Pop()
    {
        std::optional<T> oldest;
        if (_count != 0)
        {
            oldest.emplace(std::move(*_slots[_head]));
            _slots[_head].reset();
            _head = (_head + 1 == _slots.size()) ? 0 : _head + 1;
            --_count;
        }
        return oldest;
    }

    // Returns all elements with their memory, so that the caller can destroy them outside its lock.
    std::vector<std::optional<T>> TakeAll()
    {
        _head = 0;
        _count = 0;
        return std::exchange(_slots, {});
    }

private:
    void Grow()
    {
        std::vector<std::optional<T>> larger(
            std::min(_capacity, std::max<std::size_t>(16, 2 * _slots.size())));
        for (std::size_t i = 0; i < _count; ++i)
        {
            larger[i].emplace(std::move(*_slots[(_head + i) % _slots.size()]));
        }
        _slots = std::move(larger);
        _head = 0;
    }

    const std::size_t _capacity;
    std::vector<std::optional<T>> _slots;
    std::size_t _head = 0;
    std::size_t _count = 0;
};

}  // namespace Rabit
