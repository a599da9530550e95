// Makes targets from detections.
#include "TargetTable.h"

#include "Assignment.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Swarm
{
namespace
{
constexpr double MaxSigmaM = 1000;
constexpr double MaxDistanceM = 100000;
// Costs within one frame: a target in view is missed now and then; a new target or a false alarm is rare.
const double CostOfMissing = -2 * std::log(0.15);
const double CostOfNew = -2 * std::log(1e-4);
constexpr double CostOfMisfit = 1e6;

TargetFilter::Place ToLocal(const GeoPoint &origin, double latitudeDeg, double longitudeDeg)
{
    const Offset way = Between(origin, {latitudeDeg, longitudeDeg, origin.AltitudeM});
    return {way.NorthM, way.EastM};
}

double LargestSigmaM(const TargetFilter::Estimate &estimate)
{
    return std::sqrt(estimate.PositionCovariance().diagonal().maxCoeff());
}
}  // namespace

void TargetTable::Add(const Uav::Detections &frame)
{
    if (!Accept(frame))
    {
        ++_dropped;
        return;
    }
    NoteLife(frame);
    _newestS = std::max(_newestS, frame.pose.gps_time_s);
    Forget();  // an old target must not be taken for a new detection
    std::vector<Sighting> sightings = SightingsOf(frame);
    Match(sightings, frame);
    for (Sighting &sighting : sightings)
    {
        if (sighting.Target != 0 || _items.size() >= MaxTargets + MaxTentative)
            continue;
        const double time = frame.pose.gps_time_s;
        FollowedTarget target{++_lastId, TargetFilter(sighting.Place, sighting.SigmaM, time), frame.seen_by};
        target.NoteSighting(frame.seen_by, time, frame.seen_by == _aircraft);
        target.FirstPlace = sighting.Place;
        sighting.Target = target.Id;
        _items.push_back(std::move(target));
    }
    NoteTogether(sightings);
    Confirm();
    MergeThoseThatFit();
    PartThoseOnOnePlace();
    GiveNames(_newestS);
    Forget();
}

// The comparisons are written so that a NaN is refused as well.
bool TargetTable::Accept(const Uav::Detections &frame)
{
    if (!(std::abs(frame.pose.latitude_deg) <= 90 && std::abs(frame.pose.longitude_deg) <= 180))
        return false;
    if (!(frame.pose.gps_time_s >= _newestS - MaxLatenessS) || !std::isfinite(frame.pose.gps_time_s))
        return false;
    if (!_origin)
        _origin = GeoPoint{frame.pose.latitude_deg, frame.pose.longitude_deg, 0};
    return true;
}

std::vector<TargetTable::Sighting> TargetTable::SightingsOf(const Uav::Detections &frame)
{
    std::vector<Sighting> sightings;
    for (const Uav::Detection &detection : frame.items)
    {
        const bool sense = std::abs(detection.latitude_deg) <= 90 &&
                           std::abs(detection.longitude_deg) <= 180 && detection.sigma_m > 0.01f &&
                           detection.sigma_m <= MaxSigmaM;
        const auto place = sense ? ToLocal(*_origin, detection.latitude_deg, detection.longitude_deg)
                                 : TargetFilter::Place(0, 0);
        if (sense && place.norm() <= MaxDistanceM)
            sightings.push_back({place, std::hypot(static_cast<double>(detection.sigma_m), BiasM)});
        else
            ++_dropped;
    }
    return sightings;
}

// Finds the likeliest explanation of the whole frame: each detection is of a target or of something new,
// each target is seen once or missed. Costs are -2 ln of likelihoods.
void TargetTable::Match(std::vector<Sighting> &sightings, const Uav::Detections &frame)
{
    const double time = frame.pose.gps_time_s;
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < _items.size(); ++i)
    {
        const FollowedTarget &item = _items[i];
        if (LargestSigmaM(item.Filter.At(time)) <= DirectM &&
            std::any_of(sightings.begin(), sightings.end(),
                        [&](const Sighting &sighting)
                        { return item.Filter.Distance2(sighting.Place, sighting.SigmaM, time) <= Gate; }))
            near.push_back(i);
    }
    if (near.empty())
        return;
    const auto targets = static_cast<Eigen::Index>(near.size());
    const auto seen = static_cast<Eigen::Index>(sightings.size());
    Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(targets + seen, targets + seen, CostOfMisfit);
    costs.bottomRightCorner(seen, targets).setZero();
    costs.topRightCorner(targets, targets).diagonal().setConstant(CostOfMissing);
    costs.bottomLeftCorner(seen, seen).diagonal().setConstant(CostOfNew);
    for (Eigen::Index i = 0; i < targets; ++i)
        for (Eigen::Index s = 0; s < seen; ++s)
        {
            const TargetFilter &filter = _items[near[static_cast<std::size_t>(i)]].Filter;
            const Sighting &sighting = sightings[static_cast<std::size_t>(s)];
            if (filter.Distance2(sighting.Place, sighting.SigmaM, time) <= Gate)
                costs(i, s) = -2 * filter.LogDensity(sighting.Place, sighting.SigmaM, time);
        }
    const std::vector<int> columns = Assign(costs);
    const auto isGiven = [&](std::size_t i)
    { return columns[i] < seen && costs(static_cast<Eigen::Index>(i), columns[i]) < CostOfMisfit; };
    for (std::size_t i = 0; i < near.size(); ++i)
        for (std::size_t j = 0; j < near.size(); ++j)
            if (isGiven(i) && !isGiven(j) && costs(static_cast<Eigen::Index>(j), columns[i]) < CostOfMisfit)
                NoteAlone(_items[near[i]], _items[near[j]]);
    for (std::size_t i = 0; i < near.size(); ++i)
    {
        if (!isGiven(i))
            continue;
        FollowedTarget &item = _items[near[i]];
        Sighting &sighting = sightings[static_cast<std::size_t>(columns[i])];
        sighting.Target = item.Id;
        item.Filter.Update(sighting.Place, sighting.SigmaM, time);
        item.NoteSighting(frame.seen_by, time, frame.seen_by == _aircraft);
    }
}

void TargetTable::NoteTogether(const std::vector<Sighting> &sightings)
{
    for (std::size_t i = 0; i < sightings.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (sightings[i].Target != 0 && sightings[j].Target != 0)
            {
                Pair &pair = _pairs[std::minmax(sightings[i].Target, sightings[j].Target)];
                ++pair.Frames;
                pair.Alone = pair.AloneFirst = 0;
            }
}

void TargetTable::NoteAlone(const FollowedTarget &seen, const FollowedTarget &missed)
{
    if (!seen.ConfirmedS || !missed.ConfirmedS)
        return;
    Pair &pair = _pairs[KeyOf(seen, missed)];
    const FollowedTarget &first = seen.Id < missed.Id ? seen : missed;
    const FollowedTarget &second = seen.Id < missed.Id ? missed : seen;
    if (pair.Alone == 0)
    {
        pair.FirstBefore = Moment{first.Filter, first.LastS};
        pair.SecondBefore = Moment{second.Filter, second.LastS};
    }
    ++pair.Alone;
    pair.AloneFirst += &seen == &first ? 1 : 0;
}

FollowedTarget *TargetTable::Find(std::uint64_t id)
{
    const auto item =
        std::find_if(_items.begin(), _items.end(), [&](const FollowedTarget &one) { return one.Id == id; });
    return item == _items.end() ? nullptr : &*item;
}

void TargetTable::Forget()
{
    const auto gone = [&](const FollowedTarget &item)
    { return item.ConfirmedS ? item.LastS < _newestS - ForgetAfterS : item.SeenS.empty(); };
    const std::size_t before = _items.size();
    std::erase_if(_items, gone);
    const auto known = [](const FollowedTarget &item) { return item.ConfirmedS.has_value(); };
    while (std::count_if(_items.begin(), _items.end(), known) > static_cast<std::ptrdiff_t>(MaxTargets))
        _items.erase(std::min_element(_items.begin(), _items.end(),
                                      [](const FollowedTarget &a, const FollowedTarget &b) {
                                          return std::pair(!a.ConfirmedS.has_value(), a.LastS) <
                                                 std::pair(!b.ConfirmedS.has_value(), b.LastS);
                                      }));
    if (_items.size() != before)
        std::erase_if(_pairs,
                      [&](const auto &pair) { return !Find(pair.first.first) || !Find(pair.first.second); });
}

void TargetTable::Report(double gpsTimeS, Uav::Targets &targets) const
{
    targets.told_by = _aircraft;
    targets.gps_time_s = gpsTimeS;
    targets.items.clear();
    for (const FollowedTarget &item : _items)
        if (item.Name)
            targets.items.push_back(ToMessage(item, gpsTimeS));
}

std::vector<Uav::TargetName> TargetTable::NamesBeside(const FollowedTarget &item, double gpsTimeS) const
{
    constexpr std::size_t most = 8;  // the bound of the message
    const TargetFilter::Place place = item.Filter.At(gpsTimeS).Position();
    std::vector<Uav::TargetName> names;
    for (const FollowedTarget &other : _items)
        if (other.Id != item.Id && other.Name && names.size() < most && AreTwo(item, other) &&
            (other.Filter.At(gpsTimeS).Position() - place).norm() < BesideM)
            names.push_back(*other.Name);
    return names;
}

Uav::Target TargetTable::ToMessage(const FollowedTarget &item, double gpsTimeS) const
{
    const TargetFilter::Estimate estimate = item.Filter.At(gpsTimeS);
    const GeoPoint place = Moved(*_origin, {estimate.State[0], estimate.State[1], 0});
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(estimate.PositionCovariance());
    const Eigen::Vector2d major = axes.eigenvectors().col(1);  // eigenvalues rise
    Uav::Target target;
    target.name = *item.Name;
    target.formerly = item.Formerly;
    target.beside = NamesBeside(item, gpsTimeS);
    target.found_by = item.FoundBy;
    target.latitude_deg = place.LatitudeDeg;
    target.longitude_deg = place.LongitudeDeg;
    target.velocity_north_mps = static_cast<float>(estimate.State[2]);
    target.velocity_east_mps = static_cast<float>(estimate.State[3]);
    target.sigma_major_m = static_cast<float>(std::sqrt(std::max(0.0, axes.eigenvalues()[1])));
    target.sigma_minor_m = static_cast<float>(std::sqrt(std::max(0.0, axes.eigenvalues()[0])));
    target.sigma_heading_rad = static_cast<float>(std::atan2(major[1], major[0]));
    target.seen_gps_time_s = item.LastS;
    target.own_gps_time_s = item.OwnS;
    target.detections = item.Count;
    target.own_detections = item.OwnCount;
    target.seen_by = item.SeenBy;
    return target;
}

}  // namespace Swarm
