#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Cyclone
{

// Takes out of a Rabit node's announcement which of the vendor's own endpoints it has that neither side uses:
// those for the liveliness of single writers and for descriptions of types. Each pair of nodes would make
// them known, ask and acknowledge, which is half of what their discovery says. Whatever is no such
// announcement stays as it is: plain programs may use them, and with DDS Security they are signed. In place;
// true if something was taken out.
bool LeaveOutIdleEndpoints(std::span<std::uint8_t> datagram);

}  // namespace Rabit::Cyclone
