#pragma once

#include <Eigen/Core>

#include <vector>

namespace Swarm
{

// Which column each row is given so that the sum of the costs is least and each column is given once: the
// Hungarian method with potentials (Kuhn 1955, Jonker and Volgenant 1987). There must be as many columns as
// rows or more, and every cost must be finite. Takes of the order of rows * rows * columns steps.
std::vector<int> Assign(const Eigen::MatrixXd &costs);

}  // namespace Swarm
