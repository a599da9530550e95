#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace Rabit::Simulated
{

// Events ordered by time, and by insertion within one time. Their storage is reused.
template <typename Event>
class EventQueue
{
public:
    void Push(std::chrono::nanoseconds time, Event event)
    {
        std::uint32_t slot = 0;
        if (_freeSlots.empty())
        {
            slot = static_cast<std::uint32_t>(_slots.size());
            _slots.push_back(std::move(event));
        }
        else
        {
            slot = _freeSlots.back();
            _freeSlots.pop_back();
            _slots[slot] = std::move(event);
        }
        _heap.push_back({time, _nextOrder++, slot});
        std::push_heap(_heap.begin(), _heap.end(), IsLater);
    }

    bool IsEmpty() const { return _heap.empty(); }
    std::chrono::nanoseconds NextTime() const { return _heap.front().Time; }

    Event Pop()
    {
        std::pop_heap(_heap.begin(), _heap.end(), IsLater);
        const std::uint32_t slot = _heap.back().Slot;
        _heap.pop_back();
        _freeSlots.push_back(slot);
        return std::move(_slots[slot]);
    }

private:
    struct Entry
    {
        std::chrono::nanoseconds Time;
        std::uint64_t Order;
        std::uint32_t Slot;
    };
    static bool IsLater(const Entry &a, const Entry &b)
    {
        return a.Time != b.Time ? a.Time > b.Time : a.Order > b.Order;
    }

    std::vector<Entry> _heap;
    std::vector<Event> _slots;
    std::vector<std::uint32_t> _freeSlots;
    std::uint64_t _nextOrder = 0;
};

}  // namespace Rabit::Simulated
