#include "ReorderBuffer.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

namespace
{

// Approximate bytes that a part takes beside its payload.
constexpr std::size_t PartOverhead = 128;

}  // namespace

std::size_t ReorderBuffer::CostOf(const Kept &kept)
{
    return PartOverhead + kept.Payload.size() + kept.Type.size();
}

void ReorderBuffer::Drop(Parts::iterator part)
{
    const std::size_t cost = CostOf(part->second);
    _bytes -= cost;
    _bytesOfNode -= cost;
    _parts.erase(part);
}

bool ReorderBuffer::Keep(const ReceivedPart &part)
{
    const auto same = _parts.find(part.Sequence);
    if (same != _parts.end())
    {
        Kept &kept = same->second;
        if (part.Through == kept.Through && part.Flags == kept.Flags)
        {
            kept.AliveUntil = std::max(kept.AliveUntil, part.AliveUntil);
            return true;
        }
        if ((part.Flags & LinkFlagSkip) == 0)
        {
            return true;  // the message is to be skipped
        }
    }
    const std::size_t cost = PartOverhead + part.Payload.size() + part.Type.size();
    if (_bytes + cost > _limit || _bytesOfNode + cost > _limitOfNode)
    {
        return same != _parts.end();
    }
    if (same != _parts.end())
    {
        Drop(same);
    }
    _parts.emplace(part.Sequence, Kept{.Through = part.Through,
                                       .Flags = part.Flags,
                                       .AliveUntil = part.AliveUntil,
                                       .Type = std::string(part.Type),
                                       .Size = part.Size,
                                       .Payload = {part.Payload.begin(), part.Payload.end()}});
    _bytes += cost;
    _bytesOfNode += cost;
    return true;
}

ReceivedPart ReorderBuffer::First() const
{
    const auto &[sequence, kept] = *_parts.begin();
    return {.Sequence = sequence,
            .Through = kept.Through,
            .Flags = kept.Flags,
            .AliveUntil = kept.AliveUntil,
            .Type = kept.Type,
            .Size = kept.Size,
            .Payload = kept.Payload};
}

void ReorderBuffer::DropFirst()
{
    Drop(_parts.begin());
}

void ReorderBuffer::DropThrough(std::uint64_t sequence)
{
    while (!_parts.empty() && _parts.begin()->second.Through <= sequence)
    {
        Drop(_parts.begin());
    }
}

void ReorderBuffer::Clear()
{
    while (!_parts.empty())
    {
        Drop(_parts.begin());
    }
}

void ReorderBuffer::DropBeyondGap(std::uint64_t cumulative)
{
    auto part = _parts.begin();
    for (; part != _parts.end() && part->first <= cumulative + 1; ++part)
    {
        cumulative = std::max(cumulative, part->second.Through);
    }
    while (part != _parts.end())
    {
        Drop(part++);
    }
}

LinkBitmap ReorderBuffer::HeldAfter(std::uint64_t cumulative) const
{
    LinkBitmap bits{};
    for (const auto &[sequence, kept] : _parts)
    {
        const std::uint64_t first = std::max(sequence, cumulative + 1);
        const std::uint64_t last = std::min(kept.Through, cumulative + LinkWindowParts);
        for (std::uint64_t held = first; held <= last; ++held)
        {
            const std::uint64_t bit = held - cumulative - 1;
            bits[bit / 64] |= std::uint64_t{1} << (bit % 64);
        }
    }
    return bits;
}

}  // namespace Rabit
