#include "Assignment.h"

#include <limits>
#include <stdexcept>

namespace Swarm
{

// Row by row: finds the cheapest path of alternating exchanges from the new row to a free column (Dijkstra
// over reduced costs), and follows it back. Index 0 stands for "none".
std::vector<int> Assign(const Eigen::MatrixXd &costs)
{
    const auto rows = static_cast<std::size_t>(costs.rows());
    const auto columns = static_cast<std::size_t>(costs.cols());
    if (columns < rows)
        throw std::invalid_argument("Assign: fewer columns than rows");
    if (!costs.allFinite())
        throw std::invalid_argument("Assign: a cost is not finite");
    constexpr double infinite = std::numeric_limits<double>::infinity();
    std::vector<double> rowPotential(rows + 1, 0);
    std::vector<double> columnPotential(columns + 1, 0);
    std::vector<std::size_t> rowOf(columns + 1, 0);
    for (std::size_t begin = 1; begin <= rows; ++begin)
    {
        std::vector<double> distance(columns + 1, infinite);
        std::vector<std::size_t> before(columns + 1, 0);
        std::vector<bool> done(columns + 1, false);
        std::size_t column = 0;
        rowOf[0] = begin;
        do
        {
            done[column] = true;
            const std::size_t row = rowOf[column];
            double nearest = infinite;
            std::size_t next = 0;
            for (std::size_t j = 1; j <= columns; ++j)
            {
                if (done[j])
                    continue;
                const double cost =
                    costs(static_cast<Eigen::Index>(row - 1), static_cast<Eigen::Index>(j - 1)) -
                    rowPotential[row] - columnPotential[j];
                if (cost < distance[j])
                {
                    distance[j] = cost;
                    before[j] = column;
                }
                if (distance[j] < nearest)
                {
                    nearest = distance[j];
                    next = j;
                }
            }
            for (std::size_t j = 0; j <= columns; ++j)
                if (done[j])
                {
                    rowPotential[rowOf[j]] += nearest;
                    columnPotential[j] -= nearest;
                }
                else
                    distance[j] -= nearest;
            column = next;
        } while (rowOf[column] != 0);
        for (; column != 0; column = before[column])
            rowOf[column] = rowOf[before[column]];
    }
    std::vector<int> columnOf(rows, -1);
    for (std::size_t j = 1; j <= columns; ++j)
        if (rowOf[j] != 0)
            columnOf[rowOf[j] - 1] = static_cast<int>(j - 1);
    return columnOf;
}

}  // namespace Swarm
