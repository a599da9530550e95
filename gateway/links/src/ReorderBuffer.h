#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// A part as the receiver of a link sees it, out of a frame or out of the ReorderBuffer.
struct ReceivedPart
{
    std::uint64_t Sequence = 0;
    std::uint64_t Through = 0;
    std::uint8_t Flags = 0;
    // Its message surely lives until this time, by this node's clock.
    LinkTime AliveUntil = LinkNever;
    std::string_view Type;  // of the first part; empty: its type number is unknown
    std::uint64_t Size = 0;
    std::span<const std::uint8_t> Payload;
};

// Parts of one link that came before an earlier one, or could not be consumed yet. A part that does not fit
// is not kept: it is not acknowledged as held, and the sender sends it again.
class ReorderBuffer
{
public:
    // `bytesOfNode`: bytes in all such buffers of the node; must outlive the object.
    ReorderBuffer(std::size_t limit, std::size_t limitOfNode, std::size_t &bytesOfNode)
        : _limit(limit), _limitOfNode(limitOfNode), _bytesOfNode(bytesOfNode)
    {
    }
    ~ReorderBuffer() { Clear(); }
    ReorderBuffer(const ReorderBuffer &) = delete;
    ReorderBuffer &operator=(const ReorderBuffer &) = delete;

    bool Empty() const { return _parts.empty(); }
    // Keeps a copy. It replaces a part of the same number if it reaches further or may live longer. Returns
    // true if the part is here now.
    bool Keep(const ReceivedPart &part);
    // The first one; there must be one. Valid until it is dropped or replaced.
    ReceivedPart First() const;
    void DropFirst();
    // Drops the parts that end at this number or before it.
    void DropThrough(std::uint64_t sequence);
    void Clear();
    // Drops the parts that wait for one between them and `cumulative`.
    void DropBeyondGap(std::uint64_t cumulative);
    // Bit i: part cumulative + 1 + i is here.
    LinkBitmap HeldAfter(std::uint64_t cumulative) const;
    std::size_t Bytes() const { return _bytes; }

private:
    struct Kept
    {
        std::uint64_t Through = 0;
        std::uint8_t Flags = 0;
        LinkTime AliveUntil{0};
        std::string Type;
        std::uint64_t Size = 0;
        std::vector<std::uint8_t> Payload;
    };
    using Parts = std::map<std::uint64_t, Kept>;

    static std::size_t CostOf(const Kept &kept);
    void Drop(Parts::iterator part);

    const std::size_t _limit;
    const std::size_t _limitOfNode;
    std::size_t &_bytesOfNode;
    std::size_t _bytes = 0;
    Parts _parts;
};

}  // namespace Rabit
