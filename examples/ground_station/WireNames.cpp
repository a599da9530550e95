#include "WireNames.h"

#include <boost/algorithm/string/case_conv.hpp>

#include <algorithm>

namespace Ground
{

std::string WireName(RowState state)
{
    return boost::algorithm::to_lower_copy(ToText(state));
}

std::string WireNameOf(const std::string &enumerator)
{
    const std::size_t prefix = enumerator.find('_');
    if (prefix == std::string::npos)
        return "unknown";
    std::string name = boost::algorithm::to_lower_copy(enumerator.substr(prefix + 1));
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

}  // namespace Ground
