// Finds targets of the table that are one and the same.
#include "TargetTable.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace Swarm
{

TargetTable::PairKey TargetTable::KeyOf(const FollowedTarget &a, const FollowedTarget &b)
{
    return std::minmax(a.Id, b.Id);
}

bool TargetTable::AreTwo(const FollowedTarget &a, const FollowedTarget &b) const
{
    const auto pair = _pairs.find(KeyOf(a, b));
    return pair != _pairs.end() && pair->second.Frames >= TwoInFrames;
}

// Compares place and velocity. Their errors are treated as independent, which is conservative.
bool TargetTable::FitOnePlace(const FollowedTarget &a, const FollowedTarget &b) const
{
    const TargetFilter::Estimate first = a.Filter.At(_newestS);
    const TargetFilter::Estimate second = b.Filter.At(_newestS);
    Eigen::Matrix4d covariance = first.Covariance + second.Covariance;
    covariance.diagonal() += Eigen::Vector4d(BiasM * BiasM, BiasM * BiasM, 0.01, 0.01);
    const Eigen::Vector4d difference = first.State - second.State;
    return difference.dot(covariance.inverse() * difference) <= PairGate;
}

void TargetTable::Confirm()
{
    for (FollowedTarget &item : _items)
    {
        if (item.ConfirmedS)
            continue;
        while (!item.SeenS.empty() && item.SeenS.front() < _newestS - ConfirmWithinS)
            item.SeenS.pop_front();
        if (item.SeenS.size() < NeededSightings)
            continue;
        if (IsSeenAlready(item))
            item.SeenS.clear();
        else
            item.ConfirmedS = _newestS;
    }
    KnowAgain();
}

// True if the tentative target is a duplicate of one that is seen all the time: a detection with a large
// error begins one.
bool TargetTable::IsSeenAlready(const FollowedTarget &tentative) const
{
    return std::any_of(_items.begin(), _items.end(),
                       [&](const FollowedTarget &other)
                       {
                           return other.ConfirmedS && other.LastS >= tentative.FirstS &&
                                  !AreTwo(other, tentative) && FitOnePlace(other, tentative);
                       });
}

// Compares new targets with those not seen since: each pair once, the likeliest first.
void TargetTable::KnowAgain()
{
    std::vector<std::tuple<double, std::uint64_t, std::uint64_t>> pairs;
    for (const FollowedTarget &item : _items)
        for (const FollowedTarget &before : _items)
        {
            if (!item.ConfirmedS || !before.ConfirmedS || !item.FirstPlace || before.LastS >= item.FirstS)
                continue;
            Pair &pair = _pairs[KeyOf(before, item)];
            if (std::exchange(pair.IsJudged, true) || pair.Frames >= TwoInFrames)
                continue;
            const double density = before.Filter.LogDensity(*item.FirstPlace, FirstSigmaM, item.FirstS);
            if (density > std::log(NewPerM2))
                pairs.emplace_back(-density, before.Id, item.Id);
        }
    std::sort(pairs.begin(), pairs.end());
    for (const auto &[density, before, item] : pairs)
        if (Find(before) && Find(item) && Find(item)->FirstS > Find(before)->LastS)
            Merge(item, before);
}

void TargetTable::MergeThoseThatFit()
{
    std::vector<const FollowedTarget *> seen;
    for (const FollowedTarget &item : _items)
        if (item.ConfirmedS && item.LastS >= _newestS - SeenNowS)
            seen.push_back(&item);
    std::vector<PairKey> merged;
    for (std::size_t i = 0; i < seen.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
        {
            const PairKey key = KeyOf(*seen[i], *seen[j]);
            if (AreTwo(*seen[i], *seen[j]) || !FitOnePlace(*seen[i], *seen[j]))
            {
                if (const auto pair = _pairs.find(key); pair != _pairs.end())
                    pair->second.FitSinceS.reset();
                continue;
            }
            Pair &pair = _pairs[key];
            if (!pair.FitSinceS || _newestS - pair.FitLastS > SeenNowS)
                pair.FitSinceS = _newestS;
            pair.FitLastS = _newestS;
            if (_newestS - *pair.FitSinceS >= MergeAfterS)
                merged.push_back(key);
        }
    for (const auto &[first, second] : merged)
        if (Find(first) && Find(second))
            Merge(first, second);
}

// Two certainly different targets may share a place where only one is seen. The one with fewer of its
// detections is then moved back to its earlier place. Newer targets may then be that one, so pairs of it with
// newer targets are forgotten.
void TargetTable::PartThoseOnOnePlace()
{
    bool parted = false;
    for (auto &[key, pair] : _pairs)
    {
        if (pair.Alone < OneInFrames)
            continue;
        FollowedTarget *const first = Find(key.first);
        FollowedTarget *const second = Find(key.second);
        if (first && second && AreTwo(*first, *second))
        {
            const bool firstStays = 2 * pair.AloneFirst >= pair.Alone;
            FollowedTarget &misled = firstStays ? *second : *first;
            const Moment &before = firstStays ? *pair.SecondBefore : *pair.FirstBefore;
            misled.Filter = before.Filter;
            misled.LastS = before.LastS;
            ForgetPairsSince(misled);
            parted = true;
        }
        pair.Alone = pair.AloneFirst = 0;
    }
    if (parted)
        KnowAgain();
}

void TargetTable::ForgetPairsSince(const FollowedTarget &target)
{
    for (const FollowedTarget &other : _items)
        if (other.FirstS > target.LastS)
            if (const auto pair = _pairs.find(KeyOf(target, other)); pair != _pairs.end())
            {
                pair->second.Frames = 0;
                pair->second.IsJudged = false;
            }
}

// Merges the other target into the kept one, with all pairs that it was part of.
void TargetTable::Merge(std::uint64_t keptId, std::uint64_t otherId)
{
    Find(keptId)->Merge(*Find(otherId));
    std::map<PairKey, Pair> pairs;
    for (const auto &[key, pair] : _pairs)
    {
        const auto renamed = [&](std::uint64_t id) { return id == otherId ? keptId : id; };
        const PairKey now = std::minmax(renamed(key.first), renamed(key.second));
        if (now.first == now.second)
            continue;
        pairs[now].Frames += pair.Frames;
        pairs[now].IsJudged |= pair.IsJudged;
    }
    _pairs = std::move(pairs);
    std::erase_if(_items, [&](const FollowedTarget &item) { return item.Id == otherId; });
}

}  // namespace Swarm
