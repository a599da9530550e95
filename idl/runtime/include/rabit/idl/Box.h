#pragma once

#include <rabit/idl/Fresh.h>

#include <memory>
#include <type_traits>
#include <utility>

namespace Rabit::Idl
{

// A value on the heap, which keeps its owner small. A new Box has the value of Maker, and allocates nothing
// until it is written to. Copies are deep. Used by one thread at a time, like a plain value.
template <class T, class Maker = FreshValue<T>>
class Box
{
public:
    Box() = default;
    Box(const T &value) : _value(std::make_unique<T>(value)) {}
    Box(T &&value) : _value(std::make_unique<T>(std::move(value))) {}
    Box(const Box &other) : _value(other._value ? std::make_unique<T>(*other._value) : nullptr) {}
    Box(Box &&) noexcept = default;
    Box &operator=(const Box &other)
    {
        if (_value && other._value)
        {
            *_value = *other._value;
        }
        else if (this != &other)
        {
            _value = other._value ? std::make_unique<T>(*other._value) : nullptr;
        }
        return *this;
    }
    Box &operator=(Box &&) noexcept = default;

    const T &Get() const { return _value ? *_value : Start(); }
    T &Get()
    {
        if (!_value)
        {
            _value = std::make_unique<T>(Maker::Make());
        }
        return *_value;
    }
    friend bool operator==(const Box &a, const Box &b) { return a.Get() == b.Get(); }
    friend bool operator!=(const Box &a, const Box &b) { return !(a == b); }

private:
    static const T &Start()
    {
        // Never destroyed: threads may still use it when static objects are.
        static const T &start = *new T(Maker::Make());
        return start;
    }

    std::unique_ptr<T> _value;
};

// A union keeps members up to this size in itself, and larger ones in a Box, so that a union stays small.
inline constexpr std::size_t LargestKeptByItself = 32;
template <class T, class Maker = FreshValue<T>>
using Kept = std::conditional_t<(sizeof(T) <= LargestKeptByItself), T, Box<T, Maker>>;

template <class T, class Maker>
Kept<T, Maker> FreshKept()
{
    if constexpr (sizeof(T) <= LargestKeptByItself)
    {
        return Maker::Make();
    }
    else
    {
        return {};
    }
}

// The member itself, kept in place or in a Box.
template <class T>
T &Held(T &kept)
{
    return kept;
}
template <class T, class Maker>
T &Held(Box<T, Maker> &kept)
{
    return kept.Get();
}
template <class T, class Maker>
const T &Held(const Box<T, Maker> &kept)
{
    return kept.Get();
}

}  // namespace Rabit::Idl
