#pragma once

#include "Limits.h"
#include "uav.idl.h"

#include <optional>
#include <string>

namespace Ground
{

// The reason why no aircraft can be at that position: a number out of range, or no number at all. Empty if
// one can.
std::string WhyImpossible(const Uav::Pose &pose);

// Judges the positions of one aircraft as they arrive: by their ranges, and by the way from the last good one
// against the speed. Not thread-safe.
//
// A jump is believed once the positions after it have agreed with each other for JumpBelievedS, or if the
// aircraft has restarted: a simulated one may be put elsewhere, and a receiver may find its place late. A
// position of 0, 0 means that the receiver has no fix. It is neither good nor bad.
class PositionCheck
{
public:
    static constexpr Common::Range AltitudeM{-1000, 30'000};
    static constexpr double JumpBelievedS = 5;

    // The reason why the position of a new pose is bad; empty if it is not. nowS: when the pose was true, by
    // a clock that does not go back.
    std::string Look(const Uav::Pose &pose, double nowS);

private:
    struct Seen
    {
        Uav::Pose Pose;
        double AtS = 0;
    };
    static double SecondsBetween(const Seen &from, const Seen &to);
    static std::string WhyTooFar(const Seen &from, const Seen &to);

    std::optional<Seen> _good;     // the last good one
    std::optional<Seen> _doubted;  // the last one after a jump
    double _doubtedSinceS = 0;
};

}  // namespace Ground
