#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace Rabit::LinkDataCodec
{

// A LinkData as the sample of Rabit::Gateway::LinkDataSample that it is on the wire, without an object of
// that class in between: its payloads are most of what a link carries, and would be copied once more on each
// side. The bytes are those of the generated class, and what it refuses is refused here
// (tests/gateway/LinkDataCodecTest.cpp).

std::size_t EncodedSize(const LinkData &data);
// Fills exactly EncodedSize(data) bytes. False if a name is too long or contains a zero, or there are too
// many items.
bool Encode(const LinkData &data, std::span<std::uint8_t> buffer);
// Names and payloads become views into the bytes. False if they are no such sample; `data` is then
// unspecified.
bool Decode(SampleBytes bytes, LinkData &data);

}  // namespace Rabit::LinkDataCodec
