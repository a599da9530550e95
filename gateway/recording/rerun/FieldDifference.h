#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Rerun
{

// The first difference of two samples of a type, in the order of its fields.
struct FieldDifference
{
    std::string Field;  // such as `items[2].stage`; empty: as a whole
    std::string Recorded;
    std::string Computed;
};

// Compares two samples. The program must have the type. An empty sample means that there is none.
FieldDifference FirstDifference(const std::string &type, const std::vector<std::uint8_t> &recorded,
                                const std::vector<std::uint8_t> &computed);
// Returns a sample as JSON, cut off after 400 characters; `nothing` if there is none.
std::string JsonOf(const std::string &type, const std::vector<std::uint8_t> &sample);

}  // namespace Rabit::Rerun
