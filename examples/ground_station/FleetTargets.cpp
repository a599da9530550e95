#include "FleetTargets.h"

#include "FindingProgress.h"
#include "TargetName.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace Ground
{
namespace
{
// Reports within this time of each other count as simultaneous.
constexpr double TogetherS = 5;

struct ByAge
{
    bool operator()(const Uav::TargetName &a, const Uav::TargetName &b) const
    {
        return Common::IsOlder(a, b);
    }
};

// A union-find of names of one target: each name leads to an older one, or to itself.
class OneName
{
public:
    const Uav::TargetName &Of(const Uav::TargetName &name)
    {
        const auto known = _older.try_emplace(name, name).first;
        return known->second == name ? known->first : Of(known->second);
    }
    void Join(const Uav::TargetName &a, const Uav::TargetName &b)
    {
        const Uav::TargetName first = Of(a);
        const Uav::TargetName second = Of(b);
        if (!(first == second))
            _older[Common::IsOlder(first, second) ? second : first] =
                Common::IsOlder(first, second) ? first : second;
    }
    std::vector<Uav::TargetName> Others(const Uav::TargetName &oldest)
    {
        std::vector<Uav::TargetName> others;
        for (const auto &[name, older] : _older)
            if (!(name == oldest) && Of(name) == oldest)
                others.push_back(name);
        return others;
    }

private:
    std::map<Uav::TargetName, Uav::TargetName, ByAge> _older;
};

// True if another aircraft denies that the target of the first name also had the second one.
bool IsDenied(const Uav::TargetName &name, const Uav::TargetName &former,
              const std::vector<SaidOfTargets> &said, double beforeAgeS)
{
    const auto denies = [&](const Uav::Target &target, double ageS)
    {
        const bool isOwn = target.name == former && ageS < beforeAgeS;
        const auto lists = [&](const Uav::TargetName &other)
        { return std::find(target.beside.begin(), target.beside.end(), other) != target.beside.end(); };
        return isOwn || (Common::IsCalled(target, name) && lists(former)) ||
               (Common::IsCalled(target, former) && lists(name));
    };
    return std::any_of(said.begin(), said.end(),
                       [&](const SaidOfTargets &one)
                       {
                           return one.Targets &&
                                  std::any_of(one.Targets->items.begin(), one.Targets->items.end(),
                                              [&](const Uav::Target &target)
                                              { return denies(target, one.AgeS); });
                       });
}

}  // namespace

std::vector<ListedTarget> ListTargets(const std::vector<SaidOfTargets> &said)
{
    OneName names;
    for (const SaidOfTargets &one : said)
        if (one.Targets)
            for (const Uav::Target &target : one.Targets->items)
                for (const Uav::TargetName &former : target.formerly)
                    if (!IsDenied(target.name, former, said, one.AgeS - TogetherS))
                        names.Join(target.name, former);
    std::map<Uav::TargetName, ListedTarget, ByAge> list;
    for (const SaidOfTargets &one : said)
    {
        if (one.Targets)
            for (const Uav::Target &target : one.Targets->items)
            {
                ListedTarget &listed = list[names.Of(target.name)];
                if (listed.Target && listed.Target->seen_gps_time_s >= target.seen_gps_time_s)
                    continue;
                listed.Target = target;
                listed.AgeS = one.AgeS;
                listed.UnseenS = one.Targets->gps_time_s - target.seen_gps_time_s;
                listed.ToldBy = one.Aircraft;
            }
        if (one.Findings)
            for (const Uav::Finding &finding : *one.Findings)
            {
                ListedTarget &listed = list[names.Of(finding.name)];
                FoundTarget found{one.Aircraft, finding};
                found.Finding.name = names.Of(finding.name);
                if (!listed.Found ||
                    Common::ProgressOf(found.Finding) > Common::ProgressOf(listed.Found->Finding))
                    listed.Found = std::move(found);
            }
    }
    std::vector<ListedTarget> targets;
    for (auto &[name, listed] : list)
    {
        listed.Name = name;
        listed.Formerly = names.Others(name);
        if (listed.Found)
            listed.Found->Formerly = listed.Formerly;
        targets.push_back(std::move(listed));
    }
    std::sort(targets.begin(), targets.end(),
              [](const ListedTarget &a, const ListedTarget &b) {
                  return std::tie(a.Name.aircraft, a.Name.number) < std::tie(b.Name.aircraft, b.Name.number);
              });
    return targets;
}

}  // namespace Ground
