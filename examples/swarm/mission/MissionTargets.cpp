// The search, and the cooperation of the aircraft on a target.
#include "Mission.h"

#include "../Names.h"
#include "Fence.h"
#include "TargetName.h"
#include "WhyNot.h"

#include <algorithm>
#include <limits>

namespace Swarm
{

bool Mission::IsSearching() const
{
    return _mode == Uav::MissionMode::MISSION_TRANSIT || _mode == Uav::MissionMode::MISSION_SEARCH;
}

std::set<std::string> Mission::NamesOfOthers() const
{
    std::set<std::string> names;
    for (const auto &[name, pose] : _now.Others)
        names.insert(name);
    return names;
}

GeoPoint Mission::InOwnLayer(const GeoPoint &place) const
{
    const int layer = (Names::NumberOf(_aircraft) + Layers - 1) % Layers;
    return {place.LatitudeDeg, place.LongitudeDeg, _area->altitude_m + layer * LayerM};
}

// The first lane follows from the names of the present aircraft, without coordination.
void Mission::BeginSearch()
{
    std::set<std::string> all = NamesOfOthers();
    all.insert(_aircraft);
    const auto rank = static_cast<std::size_t>(std::distance(all.begin(), all.find(_aircraft)));
    _mower.emplace(*_area, rank, all.size());
}

void Mission::ActOnSearch()
{
    if (!_now.Position)
        return;
    const std::set<std::string> others = NamesOfOthers();
    if (const std::uint32_t number = _book.TakeUp({_now.GpsTimeS, _now.Targets, _now.OthersFindings, others}))
        return BeginConfirm(number);
    if (!_mower)
        BeginSearch();
    FlyIfMoved(InOwnLayer(_mower->Next(*_now.Position)), _area->speed_mps);
    if (!_mower->HasBegun())
        return;
    _mode = Uav::MissionMode::MISSION_SEARCH;
    Finish(Uav::CommandStage::COMMAND_DONE, "");
}

// Resumes the search after an interruption.
void Mission::SearchOn()
{
    _target = 0;
    _partner.clear();
    if (_mower)
        _mower->Interrupt();
    _mode = Uav::MissionMode::MISSION_TRANSIT;
    _modeSinceS = _now.NowS;
}

// An unfinished target may be taken up again when it is seen again.
void Mission::LeaveTarget(const std::string &reason)
{
    if (_mode == Uav::MissionMode::MISSION_VALIDATE)
        Refuse(_report, reason, true);
    Uav::Finding *finding = _book.Find(_target);
    if (finding && finding->stage == Uav::TargetStage::TARGET_VALIDATING)
        finding->stage = Uav::TargetStage::TARGET_FOUND;
    _target = 0;
    _partner.clear();
}

void Mission::BeginConfirm(std::uint32_t number)
{
    if (!WhyOutside(_fence, PlaceOf(*_book.Find(number))).empty())
        return _book.Reject(number, _now.GpsTimeS);
    _mode = Uav::MissionMode::MISSION_CONFIRM;
    _modeSinceS = _now.NowS;
    _target = number;
    _asked.clear();
    _anyBusy = false;
    _book.Find(number)->stage = Uav::TargetStage::TARGET_FOUND;
    AskNext();
}

std::string Mission::NearestToAsk(const GeoPoint &place) const
{
    std::string nearest;
    double nearestM = std::numeric_limits<double>::infinity();
    for (const auto &[name, pose] : _now.Others)
    {
        const double distance = LevelDistanceM(place, {pose.latitude_deg, pose.longitude_deg, 0});
        if (!_asked.contains(name) && distance < nearestM)
        {
            nearest = name;
            nearestM = distance;
        }
    }
    return nearest;
}

Uav::TargetReport Mission::ReportOf(const Uav::Finding &finding) const
{
    Uav::TargetReport report;
    report.target = finding.target;
    report.name = finding.name;
    report.seen_by = _aircraft;
    report.latitude_deg = finding.latitude_deg;
    report.longitude_deg = finding.longitude_deg;
    for (const Uav::Target &target : _now.Targets.items)
        if (target.name == finding.name)
            report.sigma_m = target.sigma_major_m;
    report.gps_time_s = _now.GpsTimeS;
    return report;
}

void Mission::RejectTarget()
{
    _book.Reject(_target, _now.GpsTimeS);
    SearchOn();
}

// Asks the nearest aircraft that was not asked in this round.
void Mission::AskNext()
{
    Uav::Finding &finding = *_book.Find(_target);
    _askedS = _now.NowS;
    while (true)
    {
        _partner = NearestToAsk(PlaceOf(finding));
        if (_partner.empty())
            break;
        _asked.insert(_partner);
        if (_output.Send(_partner, ReportOf(finding)))
        {
            finding.stage = Uav::TargetStage::TARGET_VALIDATING;
            return;
        }
    }
    finding.stage = Uav::TargetStage::TARGET_FOUND;
    if (_anyBusy && _now.NowS - _modeSinceS < PatienceS)
        return;  // ActOnConfirm begins another round
    RejectTarget();
}

void Mission::ActOnConfirm()
{
    const Uav::Finding &own = *_book.Find(_target);
    if (own.stage == Uav::TargetStage::TARGET_VALIDATED || own.stage == Uav::TargetStage::TARGET_TRACKED)
        return SearchOn();  // it turned out to be a target that this aircraft has finished
    const GeoPoint place = PlaceOf(own);
    if (!WhyOutside(_fence, place).empty())
        return RejectTarget();
    for (const auto &[name, findings] : _now.OthersFindings)
        for (const Uav::Finding &other : findings.items)
            if (name < _aircraft && _now.Others.contains(name) &&
                IsSame({own.name, place}, {other.name, PlaceOf(other)}, _now.Targets))
            {
                _book.Drop(_target);
                return SearchOn();
            }
    FlyIfMoved(InOwnLayer(place), _area->speed_mps);
    if (!_partner.empty())
    {
        if (_now.NowS - _askedS > AnswerS || !_now.Others.contains(_partner))
            AskNext();
    }
    else if (_now.NowS - _askedS > AskAgainS)
    {
        _asked.clear();
        _anyBusy = false;
        AskNext();
    }
}

void Mission::Take(const Uav::Validation &validation)
{
    if (_mode != Uav::MissionMode::MISSION_CONFIRM || validation.target != _target ||
        validation.node != _partner)
        return;
    if (!validation.accepted)
    {
        _anyBusy = _anyBusy || validation.busy;
        return AskNext();
    }
    Uav::Finding &finding = *_book.Find(_target);
    finding.stage = Uav::TargetStage::TARGET_VALIDATED;
    finding.validated_by = validation.node;
    _mode = Uav::MissionMode::MISSION_TRACK;
    _modeSinceS = _now.NowS;
    _trackedBeforeS = finding.tracked_s;
}

void Mission::ActOnTrack()
{
    Uav::Finding &finding = *_book.Find(_target);
    finding.stage = Uav::TargetStage::TARGET_TRACKED;
    finding.tracked_s = static_cast<float>(_trackedBeforeS + _now.NowS - _modeSinceS);
    const GeoPoint place = PlaceOf(finding);
    if (_now.NowS - _modeSinceS >= TrackS || !WhyOutside(_fence, place).empty())
        return SearchOn();
    FlyIfMoved(InOwnLayer(place), _area->speed_mps);
}

void Mission::Take(const Uav::TargetReport &report)
{
    if (!WhyNot(report).empty() || report.seen_by == _aircraft)
        return;  // no sender to answer, or no target to answer about
    if (const std::string outside = WhyOutside(_fence, PlaceOf(report)); !outside.empty())
        return Refuse(report, outside, false);
    const std::string reason = WhyNotLook(report);
    if (!reason.empty())
        return Refuse(report, reason, true);
    _report = report;
    _mode = Uav::MissionMode::MISSION_VALIDATE;
    _modeSinceS = _now.NowS;
    _reportGpsTimeS = _now.GpsTimeS;
}

// The reason not to look; empty if it will. An aircraft that circles its own target gives way only to one
// whose name comes earlier. Both must mean the same target, or it must wait for an aircraft that has time.
std::string Mission::WhyNotLook(const Uav::TargetReport &report)
{
    const Uav::Finding *own = _book.Find(_target);
    if (_mode == Uav::MissionMode::MISSION_CONFIRM && own)
    {
        const bool same = IsSame({own->name, PlaceOf(*own)}, {report.name, PlaceOf(report)}, _now.Targets);
        if (!same && !_partner.empty())
            return "it has found another target";
        if (report.seen_by > _aircraft)
            return same ? "it pursues that target itself" : "it waits for validation itself";
        if (same)
            _book.Drop(_target);
        SearchOn();
    }
    if (!IsSearching())
        return "it does something else";
    return WhyNotNow(false);
}

// Flies to the named target; if its name is not known here, to the target nearest to the place in the
// report.
void Mission::ActOnValidate()
{
    const GeoPoint place = PlaceOf(_report);
    const Uav::Target *nearest = nullptr;
    double nearestM = TargetBook::NearM + 3 * _report.sigma_m;
    for (const Uav::Target &target : _now.Targets.items)
    {
        if (Common::IsCalled(target, _report.name))
        {
            nearest = &target;
            break;
        }
        if (const double distance = LevelDistanceM(place, PlaceOf(target)); distance < nearestM)
        {
            nearest = &target;
            nearestM = distance;
        }
    }
    if (nearest && nearest->own_gps_time_s > _reportGpsTimeS)
    {
        Uav::Validation answer;
        answer.accepted = true;
        answer.latitude_deg = nearest->latitude_deg;
        answer.longitude_deg = nearest->longitude_deg;
        answer.sigma_m = nearest->sigma_major_m;
        Answer(_report, answer);
        return SearchOn();
    }
    if (_now.NowS - _modeSinceS > ValidateS)
    {
        Refuse(_report, "it was not to be seen", false);
        return SearchOn();
    }
    const GeoPoint goal = nearest ? PlaceOf(*nearest) : place;
    if (const std::string outside = WhyOutside(_fence, goal); !outside.empty())
    {
        Refuse(_report, outside, false);
        return SearchOn();
    }
    FlyIfMoved(InOwnLayer(goal), _area->speed_mps);
}

void Mission::Refuse(const Uav::TargetReport &report, const std::string &reason, bool busy)
{
    Uav::Validation answer;
    answer.reason = reason;
    answer.busy = busy;
    Answer(report, answer);
}

void Mission::Answer(const Uav::TargetReport &report, Uav::Validation answer)
{
    answer.target = report.target;
    answer.node = _aircraft;
    _output.Send(report.seen_by, answer);  // if it gets lost, the other aircraft asks a third one after a
                                           // while
}

}  // namespace Swarm
