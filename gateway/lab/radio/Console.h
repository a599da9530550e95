#pragma once

#include "Medium.h"

#include <string>
#include <string_view>

namespace Rabit::Radio
{

// Commands to a medium, one line each, answered by one line of JSON. Units: bit/s, bytes, milliseconds,
// percent. A NODE may be `*`, for all. Anything else is answered by {"error": "..."} and changes nothing.
//
//   rate BITS | rate unlimited        of the whole medium
//   queue BYTES [NODE]                what a node's queue holds
//   overhead BYTES                    that each frame takes on the air beyond its own
//   delay MS [jitter MS] [FROM TO]    after the air
//   loss PERCENT [burst FRAMES] [FROM TO]    in bursts of so many frames on average; 1: each by itself
//   duplicate PERCENT [FROM TO]       of the frames heard, those that come twice
//   deaf NODE FROM, hear NODE FROM    NODE hears nothing of FROM, and hears it again
//   hidden NODE NODE on|off           they do not hear each other, and may send at the same time
//   reorder on|off                    whether jitter may change the order of a link's frames
//   outage on|off                     nobody hears anything
//   counters                          of the medium and of each node, since the beginning or the last reset
//   kinds                             {node: {kind: [frames, bytes on the air]}}
//   reset                             counters from zero
//
// All but the last three are answered by {"ok": true}.
class Console
{
public:
    explicit Console(Medium &medium) : _medium(medium) {}
    std::string Answer(Time now, std::string_view line);

private:
    Medium &_medium;
};

}  // namespace Rabit::Radio
