#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace Rabit::LinkFrameCodec
{

// Encodes and decodes a LinkFrame; gateway/links/README.md has the layout. Source and destination are not
// encoded. Times are cut to whole microseconds.

// The exact number of bytes that Encode writes. `frame` must be one that a LinkNode made.
std::size_t EncodedSize(const LinkFrame &frame);
// Fills exactly EncodedSize(frame) bytes.
void Encode(const LinkFrame &frame, std::span<std::uint8_t> bytes);
// Names and payloads become views into the bytes; source and destination are left as they are. Returns false
// if the bytes are no whole frame of this version; `frame` is then unspecified. The first byte of a frame of
// any version is the version. Allocates memory in proportion to the bytes.
bool Decode(std::span<const std::uint8_t> bytes, LinkFrame &frame);

// Upper bounds, to plan a frame: bytes of a frame without data and acknowledgements, of a LinkData without
// its items, of an item without its payload, of an acknowledgement.
std::size_t HeaderSize(const LinkFrame &frame);
std::size_t DataSize(const LinkData &data);
std::size_t ItemSize(const LinkItem &item);
std::size_t AckSize(const LinkAck &ack);

}  // namespace Rabit::LinkFrameCodec
