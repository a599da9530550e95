#pragma once

#include <cstdint>
#include <deque>

namespace Ground
{

// Compares the poses of one aircraft that arrived with those that it published.
//
// Each pose carries its number, and each mission state, which travels reliably, the number of the last pose
// before it. Counting starts at the first mission state that is not older than the first pose heard. So
// nothing from before the connection counts as missed. Counting ends at the last mission state. The poses
// between the two are compared by their numbers: neither clocks nor the order in which the two messages
// arrive matter.
//
// A restarted aircraft counts from 1 again; its incarnations are added up. Not thread-safe.
class PoseCount
{
public:
    void OnPose(std::uint32_t number);
    void OnMissionState(std::uint32_t poses);

    // Poses published between the first and the last mission state that count.
    std::uint64_t Published() const { return _earlierPublished + (_open ? _end - _begin : 0); }
    // The number of those poses that arrived.
    std::uint64_t Heard() const { return _earlierHeard + (_open ? _heard : 0); }

private:
    // Limit of poses that wait for their mission state: more than a day without one.
    static constexpr std::size_t MaxWaiting = 1'000'000;

    void StartNewLife();

    std::uint64_t _earlierPublished = 0;
    std::uint64_t _earlierHeard = 0;
    bool _open = false;                  // a mission state has opened the count of this incarnation
    std::uint32_t _first = 0;            // number of the first pose of this incarnation that arrived; 0:
                                         // none yet
    std::uint32_t _newest = 0;           // number of the newest
    std::uint32_t _begin = 0;            // the poses (_begin, _end] count
    std::uint32_t _end = 0;              //
    std::uint64_t _heard = 0;            // arrived within (_begin, _end]
    std::deque<std::uint32_t> _waiting;  // arrived and above _end, rising
};

}  // namespace Ground
