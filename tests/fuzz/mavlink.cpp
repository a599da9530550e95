// Bytes of an autopilot.
#include "Input.h"
#include "mavlink/MavlinkFrame.h"
#include "mavlink/MavlinkMessages.h"

// Parts, each behind its size, as datagrams or as reads of a serial line.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    Fuzz::Input input(data, size);
    Swarm::MavlinkParser parser;
    while (!input.IsEmpty())
    {
        parser.Add(input.Part());
        while (const auto frame = parser.Next())
        {
            Fuzz::Require(frame->Payload.size() <= Swarm::MavlinkFrame::LargestPayload);
            Swarm::MavlinkHeartbeat::Decode(*frame);
            Swarm::MavlinkAttitude::Decode(*frame);
            Swarm::MavlinkGlobalPosition::Decode(*frame);
            Swarm::MavlinkPositionTarget::Decode(*frame);
        }
    }
    return 0;
}
