// Every backend beside every other one, and beside itself, as parameters of a test.
#pragma once

#include <gtest/gtest.h>
#include <rabit/transport/TransportFactory.h>

#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

using BackendPair = std::pair<std::string, std::string>;

inline std::vector<BackendPair> AllBackendPairs()
{
    std::vector<BackendPair> pairs;
    for (const auto &first : AvailableTransports())
    {
        for (const auto &second : AvailableTransports())
        {
            pairs.emplace_back(first, second);
        }
    }
    return pairs;
}

inline std::string NameOfPair(const testing::TestParamInfo<BackendPair> &backends)
{
    return backends.param.first + "_and_" + backends.param.second;
}

}  // namespace Rabit
