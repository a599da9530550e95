#include "TargetFilter.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{
namespace
{
double LogNormal(const Eigen::Vector2d &difference, const Eigen::Matrix2d &covariance)
{
    return -std::log(2 * std::numbers::pi) - std::log(covariance.determinant()) / 2 -
           difference.dot(covariance.inverse() * difference) / 2;
}
}  // namespace

TargetFilter::TargetFilter(const Place &measured, double sigmaM, double timeS)
    : _timeS(timeS), _stand(measured, sigmaM, timeS)
{
    _estimate.State << measured, 0, 0;
    const double place = sigmaM * sigmaM;
    const double speed = StartSpeedSigmaMps * StartSpeedSigmaMps;
    _estimate.Covariance = Eigen::Vector4d(place, place, speed, speed).asDiagonal();
}

TargetFilter::Estimate TargetFilter::Walking(double timeS) const
{
    const double unseen = std::max(0.0, timeS - _timeS);
    const double t = std::min(unseen, CoastS);
    Eigen::Matrix4d move = Eigen::Matrix4d::Identity();
    move.topRightCorner<2, 2>() = Eigen::Matrix2d::Identity() * t;
    // The covariance from a white-noise acceleration over that time.
    Eigen::Matrix4d noise = Eigen::Matrix4d::Zero();
    noise.topLeftCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t * t * t / 3);
    noise.topRightCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t * t / 2);
    noise.bottomLeftCorner<2, 2>() = noise.topRightCorner<2, 2>();
    noise.bottomRightCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t);
    Estimate later;
    later.State = move * _estimate.State;
    later.Covariance = move * _estimate.Covariance * move.transpose() + noise;
    if (unseen > CoastS)
    {
        later.State.tail<2>().setZero();
        later.Covariance.topRightCorner<2, 2>().setZero();
        later.Covariance.bottomLeftCorner<2, 2>().setZero();
        later.Covariance.bottomRightCorner<2, 2>() =
            Eigen::Matrix2d::Identity() * StartSpeedSigmaMps * StartSpeedSigmaMps;
        later.Covariance.topLeftCorner<2, 2>().diagonal().array() +=
            std::min(WanderM2ps * (unseen - CoastS), WanderMaxM2);
    }
    return later;
}

// Mean and covariance of the mixture of standing and walking.
TargetFilter::Estimate TargetFilter::At(double timeS) const
{
    const Estimate walking = Walking(timeS);
    const double stands = _stand.Probability();
    Eigen::Vector4d standing;
    standing << _stand.Place(), 0, 0;
    const double place = _stand.VarianceM2(timeS);
    Estimate both;
    both.State = stands * standing + (1 - stands) * walking.State;
    const Eigen::Vector4d apart = standing - walking.State;
    both.Covariance = (1 - stands) * walking.Covariance + stands * (1 - stands) * apart * apart.transpose();
    both.Covariance.diagonal() += stands * Eigen::Vector4d(place, place, 0, 0);
    return both;
}

TargetFilter::Expectation TargetFilter::Expect(double timeS) const
{
    Expectation expected;
    expected.Walking = Walking(timeS);
    const double back = std::min(0.0, timeS - _timeS);
    expected.Observation << Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity() * back;
    expected.ExtraM2 = NoiseM2ps3 * -back * back * back / 3;
    expected.Measured = expected.Observation * expected.Walking.State;
    expected.Covariance =
        expected.Observation * expected.Walking.Covariance * expected.Observation.transpose();
    return expected;
}

double TargetFilter::Distance2(const Place &measured, double sigmaM, double timeS) const
{
    const Expectation walking = Expect(timeS);
    const Eigen::Matrix2d own = Eigen::Matrix2d::Identity() * (sigmaM * sigmaM + walking.ExtraM2);
    const double stands = _stand.Probability();
    const Place apart = _stand.Place() - walking.Measured;
    const Place difference = measured - walking.Measured - stands * apart;
    const Eigen::Matrix2d covariance = (1 - stands) * walking.Covariance +
                                       stands * (1 - stands) * apart * apart.transpose() +
                                       stands * Eigen::Matrix2d::Identity() * _stand.VarianceM2(timeS) + own;
    return difference.dot(covariance.inverse() * difference);
}

double TargetFilter::LogDensity(const Place &measured, double sigmaM, double timeS) const
{
    const Expectation walking = Expect(timeS);
    const Eigen::Matrix2d own = Eigen::Matrix2d::Identity() * (sigmaM * sigmaM + walking.ExtraM2);
    const double stands = _stand.Probability();
    return std::log(
        stands * std::exp(_stand.LogDensity(measured, sigmaM, timeS)) +
        (1 - stands) * std::exp(LogNormal(measured - walking.Measured, walking.Covariance + own)) + 1e-300);
}

void TargetFilter::Update(const Place &measured, double sigmaM, double timeS)
{
    const Expectation walking = Expect(timeS);
    const Eigen::Matrix2d noise = Eigen::Matrix2d::Identity() * (sigmaM * sigmaM + walking.ExtraM2);
    const Eigen::Matrix2d innovation = walking.Covariance + noise;
    _stand.Update(measured, sigmaM, timeS, LogNormal(measured - walking.Measured, innovation));
    const Eigen::Matrix4d &covariance = walking.Walking.Covariance;
    const Eigen::Matrix<double, 4, 2> gain =
        covariance * walking.Observation.transpose() * innovation.inverse();
    _estimate.State = walking.Walking.State + gain * (measured - walking.Measured);
    // Joseph's form keeps the matrix symmetric and positive.
    const Eigen::Matrix4d rest = Eigen::Matrix4d::Identity() - gain * walking.Observation;
    _estimate.Covariance = rest * covariance * rest.transpose() + gain * noise * gain.transpose();
    _timeS = std::max(_timeS, timeS);
}

// The place of its return is evidence whether it stood meanwhile.
void TargetFilter::Inherit(const TargetFilter &before)
{
    const double sigma = std::sqrt(_stand.VarianceM2(_timeS));
    const Expectation walking = before.Expect(_timeS);
    const double walked = LogNormal(_stand.Place() - walking.Measured,
                                    walking.Covariance + Eigen::Matrix2d::Identity() * sigma * sigma);
    const double stood = before._stand.LogDensity(_stand.Place(), sigma, _timeS);
    _stand.AddEvidence(before._stand.LogOdds() +
                       std::clamp(stood - walked, -StandStill::MaxStep, StandStill::MaxStep));
}

}  // namespace Swarm
