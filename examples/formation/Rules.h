// The rules of the formation, without threads, clocks and messages between nodes.
#pragma once

#include "formation.idl.h"

#include <complex>
#include <map>
#include <optional>
#include <string>

namespace Formation
{
using Vector = std::complex<double>;  // north and east; metres, or metres a second

struct Settings
{
    double SpacingM = 20;  // between neighbours of the V
    double CruiseMps = 5;  // of the leader
    double OldS = 0.5;     // while the pose of another aircraft is older, nobody moves
    double GoneS = 10;     // but for one that was silent for longer
};
struct Other
{
    Pose Last;
    double AgeS = 0;
};

// The leader as an aircraft knows it.
struct Leader
{
    std::string Node{};            // empty: there is none
    std::optional<Vector> Goal{};  // of the leader; empty: it stays where it is
};

inline Vector PlaceOf(const Pose &pose)
{
    return {pose.north_m, pose.east_m};
}
// The place of an aircraft in the V. It depends on the number in the name alone, so that no aircraft changes
// place when another one leads.
Vector SlotOf(const std::string &node, double spacingM);
// A goal as a text in the shared table. A text that is no goal gives none.
std::string TextOf(Vector goal);
std::optional<Vector> GoalOf(const std::string &text);
// The velocity that the aircraft should have now. The leader flies to its place at the goal, the others to
// their places beside the leader. Without a leader all hold their positions. All give way to an aircraft that
// is too close.
Vector Decide(const std::string &self, const Pose &own, const Leader &leader,
              const std::map<std::string, Other> &others, const Settings &settings);
// Moves the aircraft for that time towards the wanted velocity.
void Move(Pose &pose, Vector wanted, double seconds);

}  // namespace Formation
