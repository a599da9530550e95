#pragma once

namespace Rabit
{

// How important something is that a node puts on the air, the most important first.
enum class TrafficClass
{
    Presence,   // who is there, and acknowledgements: the gateway's own, not to be chosen
    Command,    // what somebody waits for
    State,      // what must be known
    Telemetry,  // what is soon replaced by a newer value
    Bulk        // what has time: pictures, files
};

}  // namespace Rabit
