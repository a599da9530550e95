#include "TargetTable.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace Swarm
{
namespace
{
constexpr double MaxSigmaM = 1000;
constexpr double MaxDistanceM = 100000;

TargetFilter::Place ToLocal(const GeoPoint &origin, double latitudeDeg, double longitudeDeg)
{
    const Offset way = Between(origin, {latitudeDeg, longitudeDeg, origin.AltitudeM});
    return {way.NorthM, way.EastM};
}
}  // namespace

void TargetTable::Add(const Uav::Detections &frame)
{
    if (!Accept(frame))
    {
        ++_dropped;
        return;
    }
    _newestS = std::max(_newestS, frame.pose.gps_time_s);
    Forget();  // what is too old must not be taken for what is seen now
    std::vector<Sighting> sightings = SightingsOf(frame);
    Match(sightings, frame);
    for (const Sighting &sighting : sightings)
    {
        if (sighting.Used || _items.size() >= MaxTargets + MaxTentative)
            continue;
        const double time = frame.pose.gps_time_s;
        Item item{TargetFilter(sighting.Place, sighting.SigmaM, time), frame.seen_by};
        Count(item, frame);
        _items.push_back(std::move(item));
    }
    Confirm();
    Forget();
}

// Written so that a NaN is refused as well.
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
            sightings.push_back({place, detection.sigma_m});
        else
            ++_dropped;
    }
    return sightings;
}

// All pairs that fit, the best first.
void TargetTable::Match(std::vector<Sighting> &sightings, const Uav::Detections &frame)
{
    const double time = frame.pose.gps_time_s;
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < _items.size(); ++i)
    {
        const TargetFilter &filter = _items[i].Filter;
        for (std::size_t s = 0; s < sightings.size(); ++s)
        {
            const double distance2 = filter.Distance2(sightings[s].Place, sightings[s].SigmaM, time);
            if (distance2 <= Gate && (filter.At(time).Position() - sightings[s].Place).norm() <= FarthestM)
                pairs.emplace_back(distance2, i, s);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> taken(_items.size(), false);
    for (const auto &[distance2, i, s] : pairs)
    {
        if (taken[i] || sightings[s].Used)
            continue;
        taken[i] = sightings[s].Used = true;
        _items[i].Filter.Update(sightings[s].Place, sightings[s].SigmaM, time);
        Count(_items[i], frame);
    }
}

void TargetTable::Count(Item &item, const Uav::Detections &frame)
{
    const double time = frame.pose.gps_time_s;
    item.LastS = std::max(item.LastS, time);
    ++item.Count;
    if (frame.seen_by == _aircraft)
    {
        item.OwnS = std::max(item.OwnS, time);
        ++item.OwnCount;
    }
    if (item.Number == 0)
        item.SeenS.push_back(time);
    if (std::find(item.SeenBy.begin(), item.SeenBy.end(), frame.seen_by) == item.SeenBy.end() &&
        item.SeenBy.size() < MaxSeers)
        item.SeenBy.push_back(frame.seen_by);
}

// Also drops a tentative one that turns out to be a target already known, which happens when a detection was
// so far off that it fitted nothing.
void TargetTable::Confirm()
{
    for (Item &item : _items)
    {
        if (item.Number != 0)
            continue;
        while (!item.SeenS.empty() && item.SeenS.front() < _newestS - ConfirmWithinS)
            item.SeenS.pop_front();
        if (item.SeenS.size() < NeededSightings)
            continue;
        if (IsKnown(item))
            item.SeenS.clear();
        else
            item.Number = ++_lastNumber;
    }
}

bool TargetTable::IsKnown(const Item &tentative) const
{
    return std::any_of(
        _items.begin(), _items.end(),
        [&](const Item &other)
        {
            return other.Number != 0 &&
                   (other.Filter.At(_newestS).Position() - tentative.Filter.At(_newestS).Position()).norm() <
                       SameM;
        });
}

void TargetTable::Forget()
{
    std::erase_if(_items, [&](const Item &item)
                  { return item.Number == 0 ? item.SeenS.empty() : item.LastS < _newestS - ForgetAfterS; });
    const auto known = [](const Item &item) { return item.Number != 0; };
    while (std::count_if(_items.begin(), _items.end(), known) > static_cast<std::ptrdiff_t>(MaxTargets))
        _items.erase(std::min_element(
            _items.begin(), _items.end(),
            [](const Item &a, const Item &b)
            { return std::pair(a.Number == 0, a.LastS) < std::pair(b.Number == 0, b.LastS); }));
}

void TargetTable::Report(double gpsTimeS, Uav::Targets &targets) const
{
    targets.gps_time_s = gpsTimeS;
    targets.items.clear();
    for (const Item &item : _items)
        if (item.Number != 0)
            targets.items.push_back(ToMessage(item, gpsTimeS));
}

Uav::Target TargetTable::ToMessage(const Item &item, double gpsTimeS) const
{
    const TargetFilter::Estimate estimate = item.Filter.At(gpsTimeS);
    const GeoPoint place = Moved(*_origin, {estimate.State[0], estimate.State[1], 0});
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(estimate.PositionCovariance());
    const Eigen::Vector2d major = axes.eigenvectors().col(1);  // eigenvalues rise
    Uav::Target target;
    target.number = item.Number;
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
