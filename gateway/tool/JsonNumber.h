#pragma once

#include <nlohmann/json.hpp>

#include <cmath>

namespace Rabit::Tool
{

// Null if the number is not known.
inline nlohmann::ordered_json JsonNumber(double number)
{
    return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json(nullptr);
}

}  // namespace Rabit::Tool
