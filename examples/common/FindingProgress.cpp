#include "FindingProgress.h"

namespace Common
{

std::pair<int, double> ProgressOf(const Uav::Finding &finding)
{
    const bool isRejected = finding.stage == Uav::TargetStage::TARGET_REJECTED;
    return {isRejected ? -1 : static_cast<int>(finding.stage), finding.tracked_s};
}

}  // namespace Common
