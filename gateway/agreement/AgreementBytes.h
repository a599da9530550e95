#pragma once

#include <rabit/base/LittleEndian.h>

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

// Reads untrusted bytes of an agreement's datagram, never beyond the end. After a missing or a wrong value
// IsAtEnd is false, and all further values are zero or empty.
class AgreementBytes
{
public:
    explicit AgreementBytes(std::span<const std::uint8_t> left) : _left(left) {}

    template <typename Number>
    Number Take()
    {
        return LittleEndian::Read<Number>(Bytes(sizeof(Number)));
    }
    std::string Name(std::size_t longest)
    {
        const std::size_t size = Take<std::uint8_t>();
        _good = _good && size <= longest;
        const std::span<const std::uint8_t> bytes = Bytes(_good ? size : 0);
        return {bytes.begin(), bytes.end()};
    }
    // A name that is not empty.
    std::string FilledName(std::size_t longest)
    {
        std::string name = Name(longest);
        _good = _good && !name.empty();
        return name;
    }
    template <typename Kind>
    Kind TakeKind(Kind last)
    {
        const std::uint8_t kind = Take<std::uint8_t>();
        _good = _good && kind <= static_cast<std::uint8_t>(last);
        return _good ? static_cast<Kind>(kind) : Kind{};
    }
    std::size_t Count(std::size_t most)
    {
        const std::size_t count = Take<std::uint8_t>();
        _good = _good && count <= most;
        return _good ? count : 0;
    }
    bool IsAtEnd() const { return _good && _left.empty(); }

private:
    std::span<const std::uint8_t> Bytes(std::size_t size)
    {
        if (!_good || size > _left.size())
        {
            _good = false;
            return {};
        }
        const std::span<const std::uint8_t> bytes = _left.first(size);
        _left = _left.subspan(size);
        return bytes;
    }

    std::span<const std::uint8_t> _left;
    bool _good = true;
};

}  // namespace Rabit
