// A sink of a walk that writes the value in normal form: equal values give equal bytes.
#pragma once

#include <rabit/dynamic/CdrBuilder.h>
#include <rabit/dynamic/Shape.h>

#include <bit>
#include <type_traits>

namespace Rabit::Dynamic
{

class NormalSink
{
public:
    explicit NormalSink(CdrBuilder &out) : _out(out) {}

    void Bool(bool value) { _out.Put(value ? 1 : 0, 1); }
    void Char(char value) { _out.Put(static_cast<std::uint8_t>(value), 1); }
    template <class T>
    void Number(T value)
    {
        if constexpr (std::is_same_v<T, float>)
        {
            _out.Put(std::bit_cast<std::uint32_t>(value), 4);
        }
        else if constexpr (std::is_same_v<T, double>)
        {
            _out.Put(std::bit_cast<std::uint64_t>(value), 8);
        }
        else
        {
            _out.Put(static_cast<std::uint64_t>(value), sizeof(T));
        }
    }
    void Text(std::string_view text) { _out.PutString(text); }
    void Enumerator(const Shape &shape, const NamedNumber &value) { _out.Put(value.Number, shape.Size); }
    void Bits(const Shape &shape, std::uint64_t mask) { _out.Put(mask, shape.Size); }
    void Octets(std::span<const std::uint8_t> bytes, bool isSequence)
    {
        BeginList(bytes.size(), isSequence);
        _out.PutBytes(bytes);
    }
    void BeginList(std::size_t count, bool isSequence)
    {
        if (isSequence)
        {
            _out.Put(count, 4);
        }
    }
    void Element(std::size_t) {}
    void EndList() {}
    void BeginStruct() {}
    int Enter(const Shape &, std::size_t) { return 0; }
    void Leave(int) {}
    void EndStruct() {}
    void BeginUnion(const Shape &shape, std::int64_t label, int)
    {
        _out.Put(static_cast<std::uint64_t>(label), shape.Discriminator->Size);
    }
    void EndUnion() {}
    bool Ok() const { return true; }

private:
    CdrBuilder &_out;
};

}  // namespace Rabit::Dynamic
