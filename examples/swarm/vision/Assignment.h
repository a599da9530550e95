#pragma once

#include <Eigen/Core>

#include <vector>

namespace Swarm
{

// Returns the column of each row, each column at most once, such that the sum of the costs is least: the
// Hungarian method with potentials (Kuhn 1955, Jonker and Volgenant 1987). There must be at least as many
// columns as rows, and every cost must be finite. Takes O(rows * rows * columns) steps.
std::vector<int> Assign(const Eigen::MatrixXd &costs);

}  // namespace Swarm
