#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace Rabit::Tool
{

// Returns the text of the value in one line, in ASCII. Bytes that are no UTF-8 become `\ufffd`.
std::string JsonText(const nlohmann::ordered_json &value);

}  // namespace Rabit::Tool
