#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace Rabit
{

class LinkBytes;

// The bytes of a serialized message, held once for all its sendings to all nodes. Immutable once shared. May
// be null, which is an empty payload.
using LinkPayload = std::shared_ptr<const LinkBytes>;

// A block of bytes of a fixed length. Unlike a std::vector it is not filled with zeros before it is written.
class LinkBytes
{
public:
    using Memory = std::unique_ptr<std::uint8_t[]>;

    explicit LinkBytes(std::size_t size)
        : LinkBytes(std::make_unique_for_overwrite<std::uint8_t[]>(size), size)
    {
    }
    // Takes memory of at least that size.
    LinkBytes(Memory memory, std::size_t size) : _memory(std::move(memory)), _size(size) {}

    static LinkPayload CopyOf(std::span<const std::uint8_t> bytes)
    {
        auto copy = std::make_shared<LinkBytes>(bytes.size());
        std::copy(bytes.begin(), bytes.end(), copy->Writable().begin());
        return copy;
    }

    std::size_t Size() const { return _size; }
    std::span<std::uint8_t> Writable() { return {_memory.get(), _size}; }
    std::span<const std::uint8_t> View() const { return {_memory.get(), _size}; }

protected:
    // Gives the memory up, so that a derived class can reuse it when nobody holds the bytes any more.
    Memory GiveUp() { return std::move(_memory); }

private:
    Memory _memory;
    std::size_t _size;
};

}  // namespace Rabit
