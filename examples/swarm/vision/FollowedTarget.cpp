#include "FollowedTarget.h"

#include "TargetName.h"

#include <algorithm>

namespace Swarm
{

// The finder is the aircraft that saw the target first, even if its report comes later (until the target
// has a name).
void FollowedTarget::NoteSighting(const std::string &by, double timeS, bool own)
{
    if (Count == 0 || (timeS < FirstS && !Name))
    {
        FirstS = timeS;
        FoundBy = by;
    }
    LastS = std::max(LastS, timeS);
    ++Count;
    if (own)
    {
        OwnS = std::max(OwnS, timeS);
        ++OwnCount;
    }
    if (!ConfirmedS)
        SeenS.push_back(timeS);
    AddSeer(by);
}

void FollowedTarget::AddSeer(const std::string &aircraft)
{
    if (std::find(SeenBy.begin(), SeenBy.end(), aircraft) == SeenBy.end() && SeenBy.size() < MaxSeers)
        SeenBy.push_back(aircraft);
}

bool FollowedTarget::IsCalled(const Uav::TargetName &name) const
{
    return Name == name || std::find(Formerly.begin(), Formerly.end(), name) != Formerly.end();
}

bool FollowedTarget::AddName(const Uav::TargetName &name)
{
    if (IsCalled(name))
        return false;
    if (!Name)
    {
        Name = name;
        return true;
    }
    Uav::TargetName other = name;
    if (Common::IsOlder(other, *Name))
        std::swap(other, *Name);
    if (Formerly.size() == MaxFormerly)
        Formerly.erase(Formerly.begin());
    Formerly.push_back(other);
    return true;
}

void FollowedTarget::Merge(const FollowedTarget &other)
{
    constexpr double togetherS = 3;
    if (other.LastS < LastS - togetherS)
        Filter.Inherit(other.Filter);
    else if (other.Count > Count)
        Filter = other.Filter;
    if (other.Name && (!Name || Common::IsOlder(*other.Name, *Name)))
        FoundBy = other.FoundBy;
    if (other.FirstS < FirstS)
    {
        FirstS = other.FirstS;
        FirstPlace = other.FirstPlace;
    }
    LastS = std::max(LastS, other.LastS);
    OwnS = std::max(OwnS, other.OwnS);
    Count += other.Count;
    OwnCount += other.OwnCount;
    for (const std::string &seer : other.SeenBy)
        AddSeer(seer);
    if (other.Name)
        HasNews |= AddName(*other.Name);
    for (const Uav::TargetName &name : other.Formerly)
        HasNews |= AddName(name);
    HeardS = std::max(HeardS, other.HeardS);
}

}  // namespace Swarm
