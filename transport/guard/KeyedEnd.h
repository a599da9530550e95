// Samples that end a participant or an endpoint, for a vendor that reads the key from the inline QoS alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

// Returns a sample of discovery that ends something, as a message of its own to `to`, with a key hash (OMG
// DDSI-RTPS 2.3, 9.6.3.8) in its inline QoS. Empty if the sample ends nothing, has a key hash already, or
// names nothing in its payload. Nothing is checked: the message is as sound as the sample.
//
// Cyclone DDS, and with it ROS 2, writes the key into the payload alone. Fast DDS does not read it there, and
// would keep the participant until its lease ends. `header`: of a message of the sample's sender.
std::vector<std::uint8_t> WithKeyHash(std::span<const std::uint8_t> header, const GuidPrefix &to,
                                      const Submessage &submessage, const Delivery &delivery);

}  // namespace Rabit::Rtps
