#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace Rabit::Sim
{

using Time = std::chrono::nanoseconds;

// One IP packet on the simulated air.
struct AirPacket
{
    // A beat's report of the newest packet that came from a node and was not reported yet.
    struct Report
    {
        Time Late{0};
        Time ArrivedAt{0};
    };

    std::size_t From = 0;
    std::size_t Bytes = 0;
    Time SentAt{0};
    bool IsCommand = false;
    bool IsBulk = false;
    Time ReadyAt{0};                             // of a command
    std::vector<std::optional<Report>> Reports;  // of a beat or an acknowledgement, by node
    std::size_t ReportsIn = 0;                   // the number of these
};

}  // namespace Rabit::Sim
