#include "AreaLog.h"

#include <utility>

namespace Ground
{

void AreaLog::Given(const Uav::SearchArea &area, double nowS)
{
    AreaStatus status;
    status.number = area.number;
    status.latitude_deg = area.latitude_deg;
    status.longitude_deg = area.longitude_deg;
    status.north_m = area.north_m;
    status.east_m = area.east_m;
    status.altitude_m = area.altitude_m;
    status.speed_mps = area.speed_mps;
    status.lane_m = area.lane_m;
    status.given_s = nowS;
    _areas.push_back(std::move(status));
    if (_areas.size() > MaxListed)
        _areas.erase(_areas.begin());
    _before.clear();
    for (const AreaReport &report : _reports)
        _before[report.Node] = report.Declined;
    Look(std::vector<AreaReport>(_reports));
}

void AreaLog::Look(const std::vector<AreaReport> &reports)
{
    _reports = reports;
    for (AreaStatus &area : _areas)
    {
        area.answers.clear();
        for (const AreaReport &report : _reports)
            area.answers.push_back(AnswerOf(report, area));
    }
}

AreaAnswer AreaLog::AnswerOf(const AreaReport &report, const AreaStatus &area) const
{
    AreaAnswer answer;
    answer.node = report.Node;
    answer.flies = report.InForce;
    const bool isWanted = area.number == _areas.back().number;
    if (report.InForce == area.number)
    {
        answer.progress = AreaProgress::AREA_FLOWN;
        return answer;
    }
    if (!isWanted || report.InForce > area.number)
    {
        answer.progress = AreaProgress::AREA_REPLACED;
        return answer;
    }
    const auto before = _before.find(report.Node);
    const bool isNew = before != _before.end() && before->second != report.Declined;
    if (!report.Declined.empty() && (isNew || report.AtS >= area.given_s + HeardAfterS))
    {
        answer.progress = AreaProgress::AREA_DECLINED;
        answer.reason = report.Declined;
        return answer;
    }
    answer.progress = AreaProgress::AREA_SENT;
    answer.reason = report.IsLost ? "it is LOST" : "";
    return answer;
}

}  // namespace Ground
