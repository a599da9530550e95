#include "AirNode.h"

#include <algorithm>
#include <utility>

namespace Rabit::Sim
{
namespace
{

using namespace std::chrono_literals;

constexpr std::size_t LargestDatagram = 1428;
constexpr std::size_t CommandBytes = 160;
constexpr std::size_t TelemetryBytes = 190;
constexpr double BulkOutbox = 65536.0;
constexpr Time TelemetryEvery = 100ms;
constexpr Time AcknowledgementEvery = 250ms;  // LinkOptions::LongestAckDelay
constexpr Time RateEvery = 50ms;

}  // namespace

AirNode::AirNode(std::size_t number, const AirScenario &scenario)
    : _number(number),
      _scenario(scenario),
      _random(scenario.Seed * 1000 + number),
      _schedule(LargestDatagram),
      _heard(scenario.Nodes)
{
    _beat = {_schedule.AddStream(TrafficClass::Presence), _random.Between(Time(0), scenario.Beats)};
    _acknowledgement = {_schedule.AddStream(TrafficClass::Command), Time(0)};
    _command = {_schedule.AddStream(TrafficClass::Command), _random.Between(Time(0), 2 * scenario.Commands)};
    for (int i = 0; i < 2; ++i)
    {
        _telemetry.push_back(
            {_schedule.AddStream(TrafficClass::Telemetry), _random.Between(Time(0), TelemetryEvery)});
    }
    _bulk = _schedule.AddStream(TrafficClass::Bulk);
    if (scenario.Budget)
    {
        _schedule.SetBudget(*scenario.Budget, Time(0));
    }
}

std::size_t AirNode::BulkPiece() const
{
    const auto most = static_cast<double>(_schedule.Budget().LargestDatagram());
    return static_cast<std::size_t>(std::min(most, _bulkBytes));
}

void AirNode::Offer(Time now)
{
    if (now >= _beat.NextAt)
    {
        _schedule.Ready(_beat.Stream, _scenario.ReportBytes());
        _beat.NextAt += _scenario.Beats;
    }
    if (_acknowledges && now >= _acknowledgement.NextAt)
    {
        _schedule.Ready(_acknowledgement.Stream, _scenario.ReportBytes());
        _acknowledgement.NextAt = now + AcknowledgementEvery;
        _acknowledges = false;
    }
    if (now >= _command.NextAt)
    {
        _commands.push_back(now);
        _schedule.Ready(_command.Stream, CommandBytes);
        _command.NextAt = now + _random.Between(Time(0), 2 * _scenario.Commands);
    }
    const bool sends = _scenario.Offered > 0.0 && _number < _scenario.Senders;
    for (Source &source : _telemetry)
    {
        if (sends && now >= source.NextAt)
        {
            _schedule.Ready(source.Stream, TelemetryBytes);
        }
        if (now >= source.NextAt)
        {
            source.NextAt += TelemetryEvery;
        }
    }
    if (sends)
    {
        const double rate = _scenario.Offered * _scenario.BitsPerSecond / 8.0 /
                            static_cast<double>(std::min(_scenario.Nodes, _scenario.Senders));
        const double passed = std::chrono::duration<double>(now - _bulkSince).count();
        _bulkBytes = std::min(_bulkBytes + rate * passed, BulkOutbox);
        if (_bulkBytes >= 400.0)
        {
            _schedule.Ready(_bulk, BulkPiece());
        }
    }
    _bulkSince = now;
}

void AirNode::ApplyRate(Time now)
{
    if (_scenario.Budget || now < _rateAt)
    {
        return;
    }
    _rateAt = now + RateEvery;
    _schedule.SetLimits({}, _estimate.Rate(now), now);
}

void AirNode::Run(Time now, AirMedium &medium)
{
    Offer(now);
    ApplyRate(now);
    while (const auto next = _schedule.Next(now))
    {
        AirPacket packet = Make(*next, now);
        _schedule.Sent(*next, packet.Bytes, now);
        _estimate.Sent(packet.Bytes, now);
        medium.Offer(std::move(packet), now);
        ReadyAgain(*next);
    }
    _due = std::min({_beat.NextAt, _acknowledges ? _acknowledgement.NextAt : Time::max(), _command.NextAt,
                     _telemetry[0].NextAt, _telemetry[1].NextAt, _schedule.NextDue(now), now + RateEvery});
}

AirPacket AirNode::Make(StreamId stream, Time now)
{
    AirPacket packet;
    packet.From = _number;
    packet.SentAt = now;
    if (stream == _beat.Stream || stream == _acknowledgement.Stream)
    {
        packet.Bytes = _scenario.ReportBytes();
        AddReports(packet);
    }
    else if (stream == _command.Stream)
    {
        packet.Bytes = CommandBytes;
        packet.IsCommand = true;
        packet.ReadyAt = _commands.front();
        _commands.pop_front();
    }
    else if (stream == _bulk)
    {
        packet.IsBulk = true;
        packet.Bytes = BulkPiece();
        _bulkBytes -= static_cast<double>(packet.Bytes);
    }
    else
    {
        packet.Bytes = TelemetryBytes;
    }
    return packet;
}

void AirNode::AddReports(AirPacket &packet)
{
    packet.Reports.resize(_heard.size());
    const std::size_t first = _nextReport;
    for (std::size_t i = 0; i < _heard.size() && packet.ReportsIn < _scenario.MostReports(); ++i)
    {
        const std::size_t node = (first + i) % _heard.size();
        packet.Reports[node] = std::exchange(_heard[node].Fresh, std::nullopt);
        packet.ReportsIn += packet.Reports[node] ? 1 : 0;
        _nextReport = node + 1;
    }
}

void AirNode::ReadyAgain(StreamId stream)
{
    if (stream == _command.Stream && !_commands.empty())
    {
        _schedule.Ready(stream, CommandBytes);
    }
    if (stream == _bulk && _bulkBytes >= 400.0)
    {
        _schedule.Ready(stream, BulkPiece());
    }
}

void AirNode::Hear(const AirPacket &packet, Time now)
{
    if (_random.Chance(_scenario.Loss) || (_number == 0 && now >= _scenario.DeafAt))
    {
        return;
    }
    Heard &heard = _heard[packet.From];
    const Time transit = now - packet.SentAt;
    heard.Least = std::min(heard.Least.value_or(transit), transit);
    heard.Fresh = {transit - *heard.Least, now};
    if (packet.IsBulk && _scenario.Acknowledged && _number + 1 == _scenario.Nodes && !_acknowledges)
    {
        _acknowledges = true;
        _due = std::min(_due, std::max(now, _acknowledgement.NextAt));
    }
    if (!packet.Reports.empty())
    {
        TakeReport(packet, transit - *heard.Least, now);
    }
}

// `late`: how late the packet itself is.
void AirNode::TakeReport(const AirPacket &packet, Time late, Time now)
{
    const auto peer = static_cast<CapacityEstimate::Peer>(packet.From);
    if (const auto &report = packet.Reports[_number])
    {
        // The node knows how long the report was held there.
        const Time held = packet.SentAt - report->ArrivedAt;
        _estimate.Reported(peer, report->Late, now - held - late, now);
        _rateAt = now;
        _due = now;
    }
    else if (_scenario.ReportsTakeTurns && BeatFormat::TellsOfAllDelays(packet.ReportsIn))
    {
        _estimate.NothingLate(peer, now - late, now);
    }
}

}  // namespace Rabit::Sim
