#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace Rabit::LinkFrameCodec
{

// A LinkFrame as the bytes that it is on the wire; gateway/links/README.md has the layout. Source and
// destination are not among them. Times are cut to whole microseconds.

// Exactly what Encode writes. `frame` must be one that a LinkNode made.
std::size_t EncodedSize(const LinkFrame &frame);
// Fills exactly EncodedSize(frame) bytes.
void Encode(const LinkFrame &frame, std::span<std::uint8_t> bytes);
// Names and payloads become views into the bytes; source and destination are left as they are. False if the
// bytes are no frame of this version, or not as a whole; `frame` is then unspecified. The first byte of a
// frame of any version is the version. Takes memory in proportion to the bytes.
bool Decode(std::span<const std::uint8_t> bytes, LinkFrame &frame);

// Upper bounds, for who plans a frame: bytes of a frame without data and acknowledgements; of a LinkData
// without its items; of an item without its payload.
std::size_t HeaderSize(const LinkFrame &frame);
std::size_t DataSize(const LinkData &data);
std::size_t ItemSize(const LinkItem &item);
std::size_t AckSize(const LinkAck &ack);

}  // namespace Rabit::LinkFrameCodec
