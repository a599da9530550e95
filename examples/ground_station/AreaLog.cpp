#include "AreaLog.h"

#include <utility>

namespace Ground
{

void AreaLog::Given(const Uav::SearchArea &area, double nowS)
{
    AreaStatus status;
    status.area = area;
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
    const std::uint32_t number = area.area.number;
    const bool isWanted = number == _areas.back().area.number;
    if (report.InForce == number)
    {
        answer.progress = AreaProgress::AREA_FLOWN;
        return answer;
    }
    if (!isWanted || report.InForce > number)
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
