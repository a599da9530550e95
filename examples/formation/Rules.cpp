#include "Rules.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <sstream>

namespace Formation
{
namespace
{
constexpr double FastestMps = 9;
constexpr double StrongestMps2 = 4;
constexpr double Gain = 0.6;        // m/s for each metre away from the own place
constexpr double CloseShare = 0.6;  // of the spacing: closer ones are given way to

Vector Limited(Vector vector, double longest)
{
    return vector * std::min(1.0, longest / std::max(1e-9, std::abs(vector)));
}
}  // namespace

Vector SlotOf(const std::string &node, double spacingM)
{
    const std::size_t digits = node.find_last_not_of("0123456789") + 1;  // 0: all are digits
    const int number = std::atoi(node.c_str() + digits);
    const double row = number / 2 * spacingM;
    return {-row, number % 2 == 0 ? -row : row};
}

std::string TextOf(Vector goal)
{
    std::ostringstream text;
    text << goal;
    return text.str();
}

std::optional<Vector> GoalOf(const std::string &text)
{
    std::istringstream in(text);
    Vector goal;
    return in >> goal ? std::optional(goal) : std::nullopt;
}

Vector Decide(const std::string &self, const Pose &own, const Leader &leader,
              const std::map<std::string, Other> &others, const Settings &settings)
{
    Vector wanted;
    for (const auto &[node, other] : others)
        if (other.AgeS > settings.OldS && other.AgeS < settings.GoneS)
            return wanted;
    const Vector here = PlaceOf(own);
    if (leader.Node == self && leader.Goal)
        wanted = Limited(*leader.Goal + SlotOf(self, settings.SpacingM) - here, settings.CruiseMps);
    if (const auto led = others.find(leader.Node); led != others.end() && led->second.AgeS <= settings.OldS)
    {
        const Vector apart = SlotOf(self, settings.SpacingM) - SlotOf(leader.Node, settings.SpacingM);
        const Pose &pose = led->second.Last;
        wanted = Vector{pose.north_mps, pose.east_mps} + Gain * (PlaceOf(pose) + apart - here);
    }
    for (const auto &[node, other] : others)
        if (const Vector away = here - PlaceOf(other.Last); std::abs(away) < CloseShare * settings.SpacingM)
            wanted += Limited(away, 1) * (CloseShare * settings.SpacingM - std::abs(away));
    return Limited(wanted, FastestMps);
}

void Move(Pose &pose, Vector wanted, double seconds)
{
    const Vector before{pose.north_mps, pose.east_mps};
    const Vector now = before + Limited(wanted - before, StrongestMps2 * seconds);
    pose.north_mps = now.real();
    pose.east_mps = now.imag();
    pose.north_m += now.real() * seconds;
    pose.east_m += now.imag() * seconds;
}

}  // namespace Formation
