#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

// Makes new enums start at their default: C++ would make them 0, which may not be one of their values. A
// maker has the type Value and a static Make(); generated code names the makers.
namespace Rabit::Idl
{

template <class T>
struct FreshValue
{
    using Value = T;
    static Value Make() { return Value(); }
};

template <class Enum, Enum Start>
struct FreshEnum
{
    using Value = Enum;
    static constexpr Value Make() { return Start; }
};

// An array whose elements Element makes.
template <class Element, std::size_t Length>
struct FreshArray
{
    using Value = std::array<typename Element::Value, Length>;
    static constexpr Value Make()
    {
        Value value{};
        for (auto &element : value)
        {
            element = Element::Make();
        }
        return value;
    }
};

// Allocator for a vector whose new elements Maker makes, also when it is resized.
template <class Maker>
struct FreshAllocator : std::allocator<typename Maker::Value>
{
    using value_type = typename Maker::Value;
    template <class Other>
    struct rebind
    {
        using other =
            std::conditional_t<std::is_same_v<Other, value_type>, FreshAllocator, std::allocator<Other>>;
    };

    template <class T>
    void construct(T *place)
    {
        ::new (static_cast<void *>(place)) T(Maker::Make());
    }
    template <class T, class... Arguments>
    void construct(T *place, Arguments &&...arguments)
    {
        ::new (static_cast<void *>(place)) T(std::forward<Arguments>(arguments)...);
    }
};

}  // namespace Rabit::Idl
