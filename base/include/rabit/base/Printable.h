#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace Rabit
{

// The text with `?` for all characters but printable ASCII, so that text from the network stays one line of a
// log or a terminal. If it has more than `most` characters, it is cut there, and ends with `...`.
inline std::string Printable(std::string text, std::size_t most = std::string::npos)
{
    if (text.size() > most)
    {
        text.resize(most - 3);
        text += "...";
    }
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

}  // namespace Rabit
