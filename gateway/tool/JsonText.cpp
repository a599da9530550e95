#include "JsonText.h"

#include <nlohmann/json.hpp>

namespace Rabit::Tool
{

std::string JsonText(const nlohmann::ordered_json &value)
{
    return value.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace Rabit::Tool
