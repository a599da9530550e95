#pragma once

namespace Rabit
{

// Priority of the bytes that a node puts on the air, the most important first.
enum class TrafficClass
{
    Presence,   // beats of the gateway itself; a rule cannot choose it
    Command,    // messages that somebody waits for
    State,      // values that must be known
    Telemetry,  // values that are soon replaced by newer ones
    Bulk        // data that has time: pictures, files
};

}  // namespace Rabit
