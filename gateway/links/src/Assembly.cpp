#include "Assembly.h"

#include <algorithm>

namespace Rabit
{

namespace
{

constexpr std::size_t FirstRoom = 64 * 1024;
// With each growth all that has come is copied. A message of 1 MB that grows twofold is copied once more in
// all, one that grows fourfold a third of that.
constexpr std::size_t Growth = 4;

}  // namespace

void Assembly::Begin(std::string_view type, std::uint64_t size)
{
    Drop();
    _open = true;
    _type.assign(type);
    _total = size;
}

void Assembly::BeginRefused()
{
    Drop();
    _open = true;
    _refused = true;
}

bool Assembly::Append(std::span<const std::uint8_t> part, LinkTime now)
{
    if (!_refused && part.size() > _total - _size)
    {
        BeginRefused();
    }
    if (_refused)
    {
        return true;
    }
    if (!MakeRoom(_size + part.size(), now))
    {
        return false;
    }
    std::copy(part.begin(), part.end(), _bytes->Writable().begin() + static_cast<std::ptrdiff_t>(_size));
    _size += part.size();
    _grownAt = now;
    return true;
}

bool Assembly::MakeRoom(std::size_t size, LinkTime now)
{
    const std::size_t has = _bytes ? _bytes->Size() : 0;
    if (_bytes && size <= has)
    {
        return true;
    }
    const std::size_t wanted =
        std::max(size, std::min(static_cast<std::size_t>(_total), std::max(Growth * has, FirstRoom)));
    if (!_memory.Take(*this, wanted - has, now))
    {
        return false;
    }
    auto larger = std::make_shared<LinkBytes>(wanted);
    std::copy_n(Bytes().begin(), _size, larger->Writable().begin());
    _bytes = std::move(larger);
    return true;
}

std::span<const std::uint8_t> Assembly::Bytes() const
{
    return _bytes ? _bytes->View().first(_size) : std::span<const std::uint8_t>();
}

void Assembly::Drop()
{
    if (_bytes)
    {
        _memory.Give(*this, _bytes->Size());
    }
    _bytes.reset();
    _open = false;
    _refused = false;
    _total = 0;
    _size = 0;
}

}  // namespace Rabit
