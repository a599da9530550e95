#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Rerun
{

// Where two samples of a type differ first, in the order of its fields.
struct FieldDifference
{
    std::string Field;  // such as `items[2].stage`; empty: as a whole
    std::string Recorded;
    std::string Computed;
};

// The type is one of this program. Empty samples are none.
FieldDifference FirstDifference(const std::string &type, const std::vector<std::uint8_t> &recorded,
                                const std::vector<std::uint8_t> &computed);
// A sample as JSON, cut off where it is long; `nothing` if there is none.
std::string JsonOf(const std::string &type, const std::vector<std::uint8_t> &sample);

}  // namespace Rabit::Rerun
