#include "SafeText.h"

#include <algorithm>

namespace Rabit::Tool
{
namespace
{

bool IsPrintable(char c)
{
    return c >= ' ' && c <= '~';
}

}  // namespace

std::string SafeText(std::string_view text)
{
    std::string safe(text);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return !IsPrintable(c); }, '?');
    return safe;
}

std::string SafeLines(std::string_view text)
{
    std::string safe(text);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return !IsPrintable(c) && c != '\n' && c != '\t'; }, '?');
    return safe;
}

}  // namespace Rabit::Tool
