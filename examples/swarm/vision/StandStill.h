#pragma once

#include <Eigen/Core>

namespace Swarm
{

// Estimates whether a target stands or walks: it compares how well its detections fit a fixed place and a
// moving one. The answer determines how far the target may be from where it was seen last. Not thread-safe.
class StandStill
{
public:
    static constexpr double DriftM2ps = 0.05;  // how its variance grows
    static constexpr double MaxLogOdds = 2;    // never certain, as a standing target may walk off
    static constexpr double MaxStep = 4;       // of the log odds, by one detection

    StandStill(const Eigen::Vector2d &measured, double sigmaM, double timeS);

    const Eigen::Vector2d &Place() const { return _place; }
    double VarianceM2(double timeS) const;
    double Probability() const;  // that it stands
    // Natural logarithm of the probability density, per square metre, of seeing it there if it stands.
    double LogDensity(const Eigen::Vector2d &measured, double sigmaM, double timeS) const;
    // `walkingLogDensity` is that of the same detection if it walks.
    void Update(const Eigen::Vector2d &measured, double sigmaM, double timeS, double walkingLogDensity);
    // Adds the evidence of another record of the same target.
    void AddEvidence(double logOdds);
    double LogOdds() const { return _logOdds; }

private:
    Eigen::Vector2d _place;
    double _varianceM2;
    double _timeS;
    double _logOdds = 0;
};

}  // namespace Swarm
