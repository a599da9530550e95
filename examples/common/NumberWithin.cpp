#include "NumberWithin.h"

#include <cstdlib>
#include <string>

namespace Common
{

CLI::Validator NumberWithin(const Range &range)
{
    const auto refusal = [range](const std::string &text) -> std::string
    {
        char *end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (end == text.c_str() || *end != '\0')
            return "expected a number, found '" + text + "'";
        return WhyNot("it", value, range);
    };
    return {refusal, "", "within"};
}

}  // namespace Common
