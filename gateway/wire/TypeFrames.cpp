#include "wire/TypeFrames.h"

#include <rabit/base/LittleEndian.h>

namespace Rabit::TypeFrames
{

using LittleEndian::Put;
using LittleEndian::Take;

std::vector<std::uint8_t> Encode(const Part &part)
{
    std::vector<std::uint8_t> frame;
    frame.reserve(HeaderSize + part.Bytes.size());
    Put(std::uint32_t{FirstByte}, frame);  // the other three are for later
    Put(part.Definition, frame);
    Put(part.First, frame);
    Put(part.Of, frame);
    frame.insert(frame.end(), part.Bytes.begin(), part.Bytes.end());
    return frame;
}

std::optional<Part> Decode(std::span<const std::uint8_t> frame)
{
    if (frame.size() <= HeaderSize || Take<std::uint32_t>(frame) != FirstByte)
    {
        return std::nullopt;
    }
    Part part;
    part.Definition = Take<std::uint64_t>(frame);
    part.First = Take<std::uint32_t>(frame);
    part.Of = Take<std::uint32_t>(frame);
    part.Bytes = frame;
    const bool lies = part.Of > LargestText || part.First >= part.Of || frame.size() > part.Of - part.First;
    return lies ? std::nullopt : std::optional(part);
}

}  // namespace Rabit::TypeFrames
