#pragma once

#include <rabit/base/WireBytes.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// Writes a byte for the length, and the bytes of the name, of which there must be at most 255.
inline void PutName(std::string_view name, std::vector<std::uint8_t> &bytes)
{
    bytes.push_back(static_cast<std::uint8_t>(name.size()));
    bytes.insert(bytes.end(), name.begin(), name.end());
}

// Reads the untrusted fields of an agreement's datagram. After a missing or a wrong value IsAtEnd is false,
// and all further values are zero or empty.
class AgreementBytes
{
public:
    explicit AgreementBytes(std::span<const std::uint8_t> bytes) : _from(bytes) {}

    template <typename Number>
    Number Take()
    {
        return _from.Fixed<Number>();
    }
    std::string Name(std::size_t longest)
    {
        const std::string_view name = _from.Name();
        return std::string(Checked(name, name.size() <= longest));
    }
    // A name that is not empty.
    std::string FilledName(std::size_t longest)
    {
        const std::string_view name = _from.Name();
        return std::string(Checked(name, !name.empty() && name.size() <= longest));
    }
    template <typename Kind>
    Kind TakeKind(Kind last)
    {
        const std::uint8_t kind = _from.Byte();
        return static_cast<Kind>(Checked(kind, kind <= static_cast<std::uint8_t>(last)));
    }
    std::size_t Count(std::size_t most)
    {
        const std::size_t count = _from.Byte();
        return Checked(count, count <= most);
    }
    bool IsAtEnd() const { return _from.IsGood() && _from.Left() == 0; }

private:
    // The value, or an empty one if it is not allowed.
    template <typename Value>
    Value Checked(Value value, bool isAllowed)
    {
        if (!isAllowed)
        {
            _from.Fail();
            return Value{};
        }
        return value;
    }

    WireReader _from;
};

}  // namespace Rabit
