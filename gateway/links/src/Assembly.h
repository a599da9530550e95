#pragma once

#include "AssemblyMemory.h"

#include <rabit/gateway/links/LinkPayload.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace Rabit
{

// The beginning of a message of which parts are still to come. Memory is taken as bytes arrive, not when the
// peer says how many there will be.
class Assembly
{
public:
    explicit Assembly(AssemblyMemory &memory) : _memory(memory) {}
    ~Assembly() { Drop(); }
    Assembly(const Assembly &) = delete;
    Assembly &operator=(const Assembly &) = delete;

    bool IsOpen() const { return _open; }
    // One that is too large, or does not begin at its beginning: its parts are consumed, and it is refused.
    bool IsRefused() const { return _refused; }

    void Begin(std::string_view type, std::uint64_t size);
    void BeginRefused();
    // Adds a part. False: there is no memory for it now. More than was announced: refused.
    bool Append(std::span<const std::uint8_t> part, LinkTime now);
    // Takes so many bytes off again.
    void TakeBack(std::size_t bytes) { _size -= bytes; }
    bool IsComplete() const { return !_refused && _size == _total; }
    void Drop();

    const std::string &Type() const { return _type; }
    std::span<const std::uint8_t> Bytes() const;
    LinkPayload Owner() const { return _bytes; }
    std::size_t Size() const { return _size; }
    // When a part was added last.
    LinkTime GrownAt() const { return _grownAt; }

private:
    bool MakeRoom(std::size_t size, LinkTime now);

    AssemblyMemory &_memory;
    bool _open = false;
    bool _refused = false;
    std::string _type;
    std::uint64_t _total = 0;
    std::size_t _size = 0;
    LinkTime _grownAt{0};
    std::shared_ptr<LinkBytes> _bytes;  // the first _size of them count
};

}  // namespace Rabit
