#include "vision/Assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace
{

double CostOf(const Eigen::MatrixXd &costs, const std::vector<int> &columns)
{
    double sum = 0;
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
        sum += costs(i, columns[static_cast<std::size_t>(i)]);
    return sum;
}

TEST(Assignment, IsTheCheapestOfAll)
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> cost(-10, 10);
    for (int round = 0; round < 200; ++round)
    {
        const Eigen::Index rows = 1 + round % 5;
        const Eigen::Index columns = rows + round % 3;
        Eigen::MatrixXd costs(rows, columns);
        for (Eigen::Index i = 0; i < rows; ++i)
            for (Eigen::Index j = 0; j < columns; ++j)
                costs(i, j) = cost(random);
        std::vector<int> order(static_cast<std::size_t>(columns));
        std::iota(order.begin(), order.end(), 0);
        double best = std::numeric_limits<double>::infinity();
        do
            best = std::min(best, CostOf(costs, order));
        while (std::next_permutation(order.begin(), order.end()));
        EXPECT_NEAR(CostOf(costs, Swarm::Assign(costs)), best, 1e-9);
    }
}

TEST(Assignment, GivesEachColumnOnce)
{
    std::vector<int> columns = Swarm::Assign(Eigen::MatrixXd::Zero(4, 6));
    std::sort(columns.begin(), columns.end());
    EXPECT_EQ(std::unique(columns.begin(), columns.end()), columns.end());
}

TEST(Assignment, RefusesWhatHasNoAnswer)
{
    EXPECT_THROW(Swarm::Assign(Eigen::MatrixXd::Zero(3, 2)), std::invalid_argument);
    EXPECT_THROW(Swarm::Assign(Eigen::MatrixXd::Constant(1, 1, std::numeric_limits<double>::quiet_NaN())),
                 std::invalid_argument);
}

}  // namespace
