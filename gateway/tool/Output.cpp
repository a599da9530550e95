#include "Output.h"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include <cstdio>

#include "SafeText.h"

namespace Rabit::Tool::Output
{
std::string JsonText(const nlohmann::ordered_json &value)
{
    return value.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
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
