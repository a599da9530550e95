#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/Rtps.h"

namespace Rabit
{

// True if a message of our own carries samples of a topic or their repair; false if it is discovery. The
// first submessage that names a writer decides. `head` is the beginning of the message: 128 bytes are more
// than this function inspects, where the vendors put them.
bool IsOfSamples(std::span<const std::uint8_t> head);

// Tells whether a whole message announces a participant (Any), and says nothing else (Alone). A goodbye is no
// announcement.
struct Announcing
{
    bool Any = false;
    bool Alone = false;
};
Announcing AnnouncingOf(std::span<const std::uint8_t> message);

// The participant named by the first INFO_DST of a message; zero: none is named.
Rtps::GuidPrefix DestinationOf(std::span<const std::uint8_t> message);

}  // namespace Rabit
