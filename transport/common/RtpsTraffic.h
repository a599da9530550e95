#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace Rabit
{

// More of an RTPS message than IsOfSamples looks at where the vendors put it.
inline constexpr std::size_t RtpsHeadSize = 128;

// Whether a message of our own is of a topic, or of the repair of one, and not of discovery: by the first of
// its submessages that names a writer. `head` is its beginning.
bool IsOfSamples(std::span<const std::uint8_t> head);

// Whether a whole message announces a participant, and says nothing else. A goodbye is none.
struct Announcing
{
    bool Any = false;
    bool Alone = false;
};
Announcing AnnouncingOf(std::span<const std::uint8_t> message);

}  // namespace Rabit
