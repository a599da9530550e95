#include <rabit/gateway/SchemaText.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace Rabit
{
namespace
{

bool IsOfName(char letter)
{
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

// The end of the comment, the quoted text or the character that begins there; `at` if none does.
std::size_t EndOfNoCode(std::string_view idl, std::size_t at)
{
    const auto behind = [idl](std::size_t end, std::size_t length)
    { return end == std::string_view::npos ? idl.size() : end + length; };
    if (idl.substr(at, 2) == "//")
    {
        return behind(idl.find('\n', at), 0);
    }
    if (idl.substr(at, 2) == "/*")
    {
        return behind(idl.find("*/", at + 2), 2);
    }
    if (idl[at] != '"' && idl[at] != '\'')
    {
        return at;
    }
    std::size_t end = at + 1;
    while (end < idl.size() && idl[end] != idl[at])
    {
        end += idl[end] == '\\' ? 2 : 1;
    }
    return std::min(end + 1, idl.size());
}

// True if the name is an escaped keyword that is written in another case than the keyword is.
bool IsOfAnotherCase(std::string_view name)
{
    return name.starts_with('_') && name != "_TRUE" && name != "_FALSE" &&
           std::any_of(name.begin(), name.end(),
                       [](unsigned char letter) { return std::isupper(letter) != 0; });
}

}  // namespace

std::string SchemaText(const std::string &idlText)
{
    const std::string_view idl = idlText;
    std::string text;
    for (std::size_t at = 0; at < idl.size();)
    {
        std::size_t end = EndOfNoCode(idl, at);
        if (end == at)
        {
            while (end < idl.size() && IsOfName(idl[end]))
            {
                ++end;
            }
            end = std::max(end, at + 1);
            at += IsOfAnotherCase(idl.substr(at, end - at)) ? 1 : 0;
        }
        text += idl.substr(at, end - at);
        at = end;
    }
    return text;
}

}  // namespace Rabit
