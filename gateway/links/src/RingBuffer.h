#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace Rabit
{

// A queue that grows as needed, keeps its memory, and can be indexed and filled at both ends. std::deque
// allocates and frees all the time as it moves on, which the steady state of a link must not.
template <typename T>
class RingBuffer
{
public:
    bool Empty() const { return _size == 0; }
    std::size_t Size() const { return _size; }

    T &operator[](std::size_t index) { return _slots[(_head + index) & (_slots.size() - 1)]; }
    const T &operator[](std::size_t index) const { return _slots[(_head + index) & (_slots.size() - 1)]; }
    T &Front() { return (*this)[0]; }
    const T &Front() const { return (*this)[0]; }

    void PushBack(T value)
    {
        MakeRoom();
        (*this)[_size] = std::move(value);
        ++_size;
    }

    void PushFront(T value)
    {
        MakeRoom();
        _head = (_head + _slots.size() - 1) & (_slots.size() - 1);
        _slots[_head] = std::move(value);
        ++_size;
    }

    T PopFront()
    {
        T value = std::exchange(_slots[_head], T{});
        _head = (_head + 1) & (_slots.size() - 1);
        --_size;
        return value;
    }

    T PopBack()
    {
        --_size;
        return std::exchange((*this)[_size], T{});
    }

private:
    // The number of slots is always a power of two.
    void MakeRoom()
    {
        if (_size < _slots.size())
        {
            return;
        }
        std::vector<T> bigger(_slots.empty() ? 16 : _slots.size() * 2);
        for (std::size_t i = 0; i < _size; ++i)
        {
            bigger[i] = std::move((*this)[i]);
        }
        _slots.swap(bigger);
        _head = 0;
    }

    std::vector<T> _slots;
    std::size_t _head = 0;
    std::size_t _size = 0;
};

}  // namespace Rabit
