#pragma once

#include <string_view>

namespace Rabit
{

// Returns the text of a file without the byte order mark of UTF-8 that some editors write at its beginning.
inline std::string_view WithoutByteOrderMark(std::string_view text)
{
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.substr(text.substr(0, mark.size()) == mark ? mark.size() : 0);
}

}  // namespace Rabit
