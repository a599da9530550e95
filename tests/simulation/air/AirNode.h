#pragma once

#include <deque>
#include <vector>

#include "AirMedium.h"
#include "AirPacket.h"
#include "AirScenario.h"
#include "SimRandom.h"
#include "air/AirSchedule.h"
#include "air/CapacityEstimate.h"

namespace Rabit::Sim
{

// A node that sends beats, commands, two telemetry messages at 10 Hz, and bulk, by its schedule.
class AirNode
{
public:
    AirNode(std::size_t number, const AirScenario &scenario);

    // Returns when Run is to be called next.
    Time Due() const { return _due; }
    void Run(Time now, AirMedium &medium);
    void Hear(const AirPacket &packet, Time now);

    const AirSchedule &Schedule() const { return _schedule; }
    std::optional<double> Rate(Time now) const { return _estimate.Rate(now); }

private:
    // The time at which a stream of packets has the next one.
    struct Source
    {
        StreamId Stream;
        Time NextAt{0};
    };

    struct Heard
    {
        std::optional<Time> Least;
        std::optional<AirPacket::Report> Fresh;  // of the newest, not sent yet
    };

    void Offer(Time now);
    void ApplyRate(Time now);
    std::size_t BulkPiece() const;
    AirPacket Make(StreamId stream, Time now);
    void AddReports(AirPacket &packet);
    void TakeReport(const AirPacket &packet, Time late, Time now);
    void ReadyAgain(StreamId stream);

    const std::size_t _number;
    const AirScenario _scenario;
    SimRandom _random;
    AirSchedule _schedule;
    CapacityEstimate _estimate;
    Source _beat;
    Source _acknowledgement;  // NextAt: not before
    bool _acknowledges = false;
    Source _command;
    std::vector<Source> _telemetry;
    StreamId _bulk;
    std::deque<Time> _commands;  // when each became ready
    double _bulkBytes = 0.0;
    Time _bulkSince{0};
    Time _rateAt{0};
    std::vector<Heard> _heard;
    std::size_t _nextReport = 0;  // the node whose turn it is to be reported on
    Time _due{0};
};

}  // namespace Rabit::Sim
