#include "SafeText.h"

#include <rabit/base/Printable.h>

#include <algorithm>

namespace Rabit::Tool
{

std::string SafeText(std::string_view text)
{
    return Printable(std::string(text));
}

std::string SafeLines(std::string_view text)
{
    std::string safe(text);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return (c < ' ' || c > '~') && c != '\n' && c != '\t'; }, '?');
    return safe;
}

}  // namespace Rabit::Tool
