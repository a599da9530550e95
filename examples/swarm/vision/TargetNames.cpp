// The names that this and the other aircraft give to targets.
#include "TargetName.h"
#include "TargetTable.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace Swarm
{

// The finder names a target; the others wait for its name, at most NameWaitS.
void TargetTable::GiveNames(double gpsTimeS)
{
    for (FollowedTarget &item : _items)
        if (item.ConfirmedS && !item.Name &&
            (item.FoundBy == _aircraft || gpsTimeS - *item.ConfirmedS >= NameWaitS))
            GiveName(item);
}

void TargetTable::GiveName(FollowedTarget &target)
{
    Uav::TargetName name;
    name.aircraft = _aircraft;
    name.number = ++_lastNumber;
    name.since_gps_time_s = target.FirstS;
    target.Name = name;
    target.HasNews = true;
}

Uav::Targets TargetTable::Tell(double gpsTimeS)
{
    GiveNames(gpsTimeS);
    Uav::Targets targets;
    targets.told_by = _aircraft;
    targets.gps_time_s = gpsTimeS;
    TellNeighbours();
    for (FollowedTarget &item : _items)
    {
        if (!item.Name)
            continue;
        const bool again = item.Name->aircraft == _aircraft && gpsTimeS - item.ToldS >= TellAgainS;
        const bool forOthers = gpsTimeS - std::max(item.ToldS, item.HeardS) >= TellForOthersS;
        if (!item.HasNews && !again && !forOthers)
            continue;
        item.HasNews = false;
        item.ToldS = gpsTimeS;
        targets.items.push_back(ToMessage(item, gpsTimeS));
    }
    return targets;
}

// Neighbouring targets can only be told apart together, so all of them are sent with one that has news.
void TargetTable::TellNeighbours()
{
    std::vector<std::uint64_t> neighbours;
    for (const FollowedTarget &item : _items)
        if (item.HasNews)
            for (const FollowedTarget &other : _items)
                if (other.Name && AreTwo(item, other) && other.LastS >= _newestS - SeenNowS)
                    neighbours.push_back(other.Id);
    for (const std::uint64_t id : neighbours)
        Find(id)->HasNews = true;
}

// Handles targets with known names first, so that no other one is taken for one of them.
void TargetTable::Hear(const Uav::Targets &told)
{
    if (told.told_by == _aircraft || told.told_by.empty() || !std::isfinite(told.gps_time_s) ||
        (_newestS > 0 && !(std::abs(told.gps_time_s - _newestS) < ForgetAfterS)))
    {
        ++_dropped;
        return;
    }
    NoteNumbers(told);
    for (const Uav::Target &message : told.items)
        TakeApart(message);
    std::vector<Told> unknown;
    std::vector<std::uint64_t> taken;
    for (const Uav::Target &message : told.items)
    {
        const std::optional<Told> one = Read(message, told);
        if (!one)
        {
            ++_dropped;
            continue;
        }
        const std::uint64_t id = FindByName(*one);
        if (id == 0)
            unknown.push_back(*one);
        else if (!IsElsewhere(*Find(id), *one))
        {
            if (const std::uint64_t agreed = Agree(id, *one, told))
            {
                Learn(*Find(agreed), *one, told.gps_time_s);
                taken.push_back(agreed);
            }
        }
        else if (GiveWay(id, *one, told.told_by))
            unknown.push_back(*one);
    }
    for (const Told &one : unknown)
    {
        const std::uint64_t id = FindByPlace(one, taken);
        if (id == 0)
        {
            AddToldTarget(one, told.gps_time_s);
            continue;
        }
        Learn(*Find(id), one, told.gps_time_s);
        taken.push_back(id);
    }
    KnowAgain();
    Forget();
}

// Numbers that an earlier incarnation of this aircraft gave are not used again.
void TargetTable::NoteNumbers(const Uav::Targets &told)
{
    for (const Uav::Target &target : told.items)
        if (target.name.aircraft == _aircraft && Common::MakesSense(target.name))
            _lastNumber = std::max(_lastNumber, target.name.number);
}

// An aircraft that restarts its frame count knows no names, so all names are sent to it before it gives
// any.
void TargetTable::NoteLife(const Uav::Detections &frame)
{
    constexpr std::uint32_t late = 20;
    if (frame.seen_by == _aircraft || (_frames.size() >= MaxTargets && !_frames.contains(frame.seen_by)))
        return;
    const auto [known, isNew] = _frames.try_emplace(frame.seen_by, frame.frame);
    if (isNew || (frame.frame < known->second && known->second - frame.frame > late))
        for (FollowedTarget &item : _items)
            item.HasNews |= item.Name.has_value();
    if (isNew || frame.frame > known->second || known->second - frame.frame > late)
        known->second = frame.frame;
}

// The comparisons are written so that a NaN is refused as well.
std::optional<TargetTable::Told> TargetTable::Read(const Uav::Target &message, const Uav::Targets &told)
{
    const bool names = Common::MakesSense(message.name) &&
                       std::all_of(message.formerly.begin(), message.formerly.end(), Common::MakesSense);
    const bool place = std::abs(message.latitude_deg) <= 90 && std::abs(message.longitude_deg) <= 180 &&
                       message.sigma_major_m >= 0 && message.sigma_major_m <= 1000;
    const bool time = message.seen_gps_time_s <= told.gps_time_s + MaxLatenessS &&
                      message.seen_gps_time_s > told.gps_time_s - ForgetAfterS &&
                      message.name.since_gps_time_s <= message.seen_gps_time_s;
    if (!names || !place || !time)
        return std::nullopt;
    if (!_origin)
        _origin = GeoPoint{message.latitude_deg, message.longitude_deg, 0};
    const Offset way = Between(*_origin, {message.latitude_deg, message.longitude_deg, _origin->AltitudeM});
    const TargetFilter::Place at(way.NorthM, way.EastM);
    if (!(at.norm() <= 100000))
        return std::nullopt;
    return Told{&message, at, std::max(0.1, static_cast<double>(message.sigma_major_m))};
}

// Separates targets that the other aircraft has seen side by side, and that were taken for one here, or
// might be.
void TargetTable::TakeApart(const Uav::Target &told)
{
    for (const Uav::TargetName &beside : told.beside)
    {
        const FollowedTarget *first = nullptr;
        const FollowedTarget *second = nullptr;
        for (FollowedTarget &item : _items)
        {
            if (item.IsCalled(told.name) && item.IsCalled(beside))
                std::erase(item.Formerly, item.Name == told.name ? beside : told.name);
            first = item.IsCalled(told.name) ? &item : first;
            second = item.IsCalled(beside) ? &item : second;
        }
        if (first && second && first != second)
        {
            int &frames = _pairs[KeyOf(*first, *second)].Frames;
            frames = std::max(frames, TwoInFrames);
        }
    }
}

// The target that has any of these names; 0 if there is none. If several targets have one, they are merged,
// as the other aircraft has done, unless this one sees them at different places.
std::uint64_t TargetTable::FindByName(const Told &told)
{
    const Uav::TargetName &name = told.Message->name;
    std::vector<std::uint64_t> meant;
    for (const FollowedTarget &item : _items)
        if (item.Name && (item.IsCalled(name) || Common::IsCalled(*told.Message, *item.Name)))
            meant.push_back(item.Id);
    const auto isElsewhere = [&](std::uint64_t id) { return IsElsewhere(*Find(id), told); };
    if (std::all_of(meant.begin(), meant.end(), isElsewhere))
    {
        const auto exact = std::find_if(meant.begin(), meant.end(),
                                        [&](std::uint64_t id) { return Find(id)->Name == name; });
        return meant.empty() ? 0 : exact == meant.end() ? meant.front() : *exact;
    }
    for (const std::uint64_t id : meant)
        if (isElsewhere(id))
            std::erase(Find(id)->Formerly, name);
    std::erase_if(meant, isElsewhere);
    std::sort(meant.begin(), meant.end(),
              [&](std::uint64_t a, std::uint64_t b) { return Find(a)->LastS > Find(b)->LastS; });
    for (std::size_t i = 1; i < meant.size(); ++i)
        if (!AreTwo(*Find(meant[0]), *Find(meant[i])))
            Merge(meant[0], meant[i]);
    return meant[0];
}

// True if both aircraft see it now, but at different places.
bool TargetTable::IsElsewhere(const FollowedTarget &target, const Told &told) const
{
    const double time = told.Message->seen_gps_time_s;
    return std::abs(target.LastS - time) < SeenNowS &&
           (target.Filter.At(time).Position() - told.Place).norm() > SwappedM &&
           target.Filter.Distance2(told.Place, std::hypot(told.SigmaM, BiasM), time) > Gate;
}

// Called if the other aircraft sees a target again that is not seen here under that name. If this aircraft
// sees an unnamed target there, it is that one. If that target has another name, the two aircraft have
// recognized one target differently: the aircraft whose name comes first is right. Returns the target, 0 if
// this aircraft is right.
std::uint64_t TargetTable::Agree(std::uint64_t id, const Told &told, const Uav::Targets &all)
{
    const double time = told.Message->seen_gps_time_s;
    if (Find(id)->LastS >= time - SeenNowS)
        return id;
    const std::uint64_t hereId = FindByPlace(told, {id});
    FollowedTarget *const here = hereId == 0 ? nullptr : Find(hereId);
    if (!here || here->LastS < time - SeenNowS)
        return id;
    const bool bothAreThere = here->Name && std::any_of(all.items.begin(), all.items.end(),
                                                        [&](const Uav::Target &other) {
                                                            return Common::IsCalled(other, *here->Name) &&
                                                                   other.seen_gps_time_s >= time - SeenNowS;
                                                        });
    if (bothAreThere)
        return id;
    FollowedTarget &gone = *Find(id);
    if (!here->Name)
    {
        Merge(hereId, id);
        return hereId;
    }
    if (all.told_by > _aircraft)
    {
        here->HasNews = true;
        return 0;
    }
    std::swap(here->Name, gone.Name);
    std::swap(here->Formerly, gone.Formerly);
    return hereId;
}

// Returns true if the name, or the former name, is free now for the other aircraft's target.
bool TargetTable::GiveWay(std::uint64_t id, const Told &told, const std::string &toldBy)
{
    if (toldBy > _aircraft)
        return false;
    FollowedTarget &mine = *Find(id);
    std::erase(mine.Formerly, told.Message->name);
    if (mine.Name != told.Message->name)
        return !mine.IsCalled(told.Message->name);
    const std::uint64_t other = FindByPlace(told, {id});
    FollowedTarget *const theirs = other == 0 ? nullptr : Find(other);
    if (theirs && theirs->Name)
    {
        std::swap(theirs->Name, mine.Name);
        std::swap(theirs->Formerly, mine.Formerly);
        mine.HasNews = theirs->HasNews = true;
        return false;
    }
    mine.Name.reset();
    mine.FirstS = mine.LastS;  // its new name is newer than the one that it gives up
    GiveName(mine);
    return true;
}

// A target of this table that may be the other aircraft's one with an unknown name, and is not in `taken`;
// 0 if there is none.
std::uint64_t TargetTable::FindByPlace(const Told &told, const std::vector<std::uint64_t> &taken)
{
    const double time = told.Message->seen_gps_time_s;
    const double sigma = std::hypot(told.SigmaM, BiasM);
    double best = std::log(NewPerM2);
    std::uint64_t found = 0;
    for (const FollowedTarget &item : _items)
    {
        if (!item.ConfirmedS || std::find(taken.begin(), taken.end(), item.Id) != taken.end())
            continue;
        const double density = item.Filter.LogDensity(told.Place, sigma, time);
        if (density > best && item.Filter.Distance2(told.Place, sigma, time) <= Gate &&
            item.Filter.At(time).PositionCovariance().diagonal().maxCoeff() <= DirectM * DirectM)
        {
            best = density;
            found = item.Id;
        }
    }
    return found;
}

void TargetTable::Learn(FollowedTarget &target, const Told &told, double gpsTimeS)
{
    const Uav::Target &message = *told.Message;
    target.HeardS = std::max(target.HeardS, gpsTimeS);
    const auto isAnothers = [&](const Uav::TargetName &name)
    {
        return std::any_of(_items.begin(), _items.end(),
                           [&](const FollowedTarget &other)
                           { return other.Id != target.Id && other.Name == name; });
    };
    if (!isAnothers(message.name))
        target.AddName(message.name);
    for (const Uav::TargetName &name : message.formerly)
        if (!isAnothers(name))
            target.AddName(name);
    // The other aircraft has an outdated name, so this one is news to it.
    target.HasNews |= target.Name != message.name;
    for (const std::string &seer : message.seen_by)
        target.AddSeer(seer);
    if (message.seen_gps_time_s <= target.LastS + SeenNowS)
        return;
    TargetFilter now(told.Place, told.SigmaM, message.seen_gps_time_s);
    now.Inherit(target.Filter);
    target.Filter = now;
    target.LastS = message.seen_gps_time_s;
}

void TargetTable::AddToldTarget(const Told &told, double gpsTimeS)
{
    if (_items.size() >= MaxTargets + MaxTentative)
        return;
    const Uav::Target &message = *told.Message;
    FollowedTarget target{++_lastId, TargetFilter(told.Place, told.SigmaM, message.seen_gps_time_s),
                          message.found_by};
    target.FirstS = message.name.since_gps_time_s;
    target.LastS = message.seen_gps_time_s;
    target.Count = message.detections;
    target.ConfirmedS = gpsTimeS;
    _items.push_back(std::move(target));
    Learn(_items.back(), told, gpsTimeS);
}

}  // namespace Swarm
