#include "StandStill.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{

StandStill::StandStill(const Eigen::Vector2d &measured, double sigmaM, double timeS)
    : _place(measured), _varianceM2(sigmaM * sigmaM), _timeS(timeS)
{
}

double StandStill::VarianceM2(double timeS) const
{
    return _varianceM2 + DriftM2ps * std::max(0.0, timeS - _timeS);
}

double StandStill::Probability() const
{
    return 1 / (1 + std::exp(-_logOdds));
}

double StandStill::LogDensity(const Eigen::Vector2d &measured, double sigmaM, double timeS) const
{
    const double variance = VarianceM2(timeS) + sigmaM * sigmaM;
    return -std::log(2 * std::numbers::pi * variance) - (measured - _place).squaredNorm() / (2 * variance);
}

void StandStill::Update(const Eigen::Vector2d &measured, double sigmaM, double timeS,
                        double walkingLogDensity)
{
    AddEvidence(std::clamp(LogDensity(measured, sigmaM, timeS) - walkingLogDensity, -MaxStep, MaxStep));
    _varianceM2 = VarianceM2(timeS);
    const double gain = _varianceM2 / (_varianceM2 + sigmaM * sigmaM);
    _place += gain * (measured - _place);
    _varianceM2 *= 1 - gain;
    _timeS = std::max(_timeS, timeS);
}

void StandStill::AddEvidence(double logOdds)
{
    _logOdds = std::clamp(_logOdds + logOdds, -MaxLogOdds, MaxLogOdds);
}

}  // namespace Swarm
