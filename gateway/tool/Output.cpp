#include "Output.h"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>

#include "SafeText.h"

namespace Rabit::Tool::Output
{
namespace
{

using Json = nlohmann::ordered_json;

void WriteLargeIntegersAsText(Json &value)
{
    constexpr std::int64_t exact = std::int64_t{1} << 53;
    if (value.is_structured())
    {
        for (Json &part : value)
        {
            WriteLargeIntegersAsText(part);
        }
    }
    else if (value.is_number_unsigned() ? value.get<std::uint64_t>() > std::uint64_t{exact}
                                        : value.is_number_integer() && (value.get<std::int64_t>() > exact ||
                                                                        value.get<std::int64_t>() < -exact))
    {
        value = value.dump();
    }
}

}  // namespace

std::string JsonText(Json value)
{
    WriteLargeIntegersAsText(value);
    return value.dump(-1, ' ', true, Json::error_handler_t::replace);
}

bool Line(std::string_view line)
{
    return std::fwrite(line.data(), 1, line.size(), stdout) == line.size() &&
           std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0;
}

bool Object(const nlohmann::ordered_json &object)
{
    return Line(JsonText(object));
}

void Talk(std::string_view text)
{
    std::fprintf(stderr, "rabit: %s\n", SafeText(text).c_str());
}

void BeginScreen()
{
    if (::isatty(STDOUT_FILENO) != 0)
    {
        std::fputs("\x1b[H\x1b[2J", stdout);
    }
}

}  // namespace Rabit::Tool::Output
