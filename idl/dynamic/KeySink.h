// A sink of a walk that hashes the key of a struct.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <rabit/idl/KeyHasher.h>

#include <span>
#include <string_view>

namespace Rabit::Dynamic
{

class KeySink
{
public:
    explicit KeySink(Idl::KeyHasher &hasher) : _key(&hasher) {}

    void Bool(bool value) { Put(static_cast<std::uint8_t>(value)); }
    void Char(char value) { Put(value); }
    template <class T>
    void Number(T value)
    {
        Put(value);
    }
    void Text(std::string_view text)
    {
        if (_key != nullptr)
        {
            _key->PutString(text);
        }
    }
    void Enumerator(const Shape &shape, const NamedNumber &value) { PutSized(shape.Size, value.Number); }
    void Bits(const Shape &shape, std::uint64_t mask) { PutSized(shape.Size, mask); }
    void Octets(std::span<const std::uint8_t> bytes, bool)
    {
        if (_key != nullptr)
        {
            for (const std::uint8_t byte : bytes)
            {
                _key->Put(byte);
            }
        }
    }
    // Keys contain neither sequences nor unions.
    void BeginList(std::size_t, bool) {}
    void Element(std::size_t) {}
    void EndList() {}
    void BeginStruct() {}
    Idl::KeyHasher *Enter(const Shape &shape, std::size_t index)
    {
        Idl::KeyHasher *const outside = _key;
        // If a struct without keys of its own is a key, all of its members count.
        if (shape.HasKey && !shape.Parts[index].Key)
        {
            _key = nullptr;
        }
        return outside;
    }
    void Leave(Idl::KeyHasher *outside) { _key = outside; }
    void EndStruct() {}
    void BeginUnion(const Shape &, std::int64_t, int) {}
    void EndUnion() {}
    bool Ok() const { return true; }

private:
    template <class T>
    void Put(T value)
    {
        if (_key != nullptr)
        {
            _key->Put(value);
        }
    }
    void PutSized(unsigned size, std::uint64_t value)
    {
        switch (size)
        {
            case 1:
                return Put(static_cast<std::uint8_t>(value));
            case 2:
                return Put(static_cast<std::uint16_t>(value));
            case 4:
                return Put(static_cast<std::uint32_t>(value));
            default:
                return Put(value);
        }
    }

    Idl::KeyHasher *_key;
};

}  // namespace Rabit::Dynamic
