#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace Rabit
{

// The bytes of a serialized message: held once however often and to however many nodes it is sent. Immutable
// once shared. May be null, which is an empty payload.
using LinkPayload = std::shared_ptr<const std::vector<std::uint8_t>>;

}  // namespace Rabit
