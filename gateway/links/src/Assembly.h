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

// The received beginning of a message in several parts. Memory grows as bytes arrive, not with the size that
// the peer announces.
class Assembly
{
public:
    explicit Assembly(AssemblyMemory &memory) : _memory(memory) {}
    ~Assembly() { Drop(); }
    Assembly(const Assembly &) = delete;
    Assembly &operator=(const Assembly &) = delete;

    bool IsOpen() const { return _open; }

    void Begin(std::string_view type, std::uint64_t size);
    void BeginRefused();
    // Adds a part. Returns false if there is no memory for it now. A message that exceeds its announced size
    // is refused.
    bool Append(std::span<const std::uint8_t> part, LinkTime now);
    // Removes the last `bytes` bytes again.
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
    // The message is too large, or its first part is missing: its parts are consumed, and it is refused.
    bool _refused = false;
    std::string _type;
    std::uint64_t _total = 0;
    std::size_t _size = 0;
    LinkTime _grownAt{0};
    std::shared_ptr<LinkBytes> _bytes;  // the first _size of them count
};

}  // namespace Rabit
