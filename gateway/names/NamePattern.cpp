#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace Rabit
{
namespace
{

// A table, since the names in every datagram of the links are checked.
constexpr std::array<bool, 256> NodeCharacters = []
{
    std::array<bool, 256> table{};
    for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-"))
    {
        table[static_cast<unsigned char>(c)] = true;
    }
    return table;
}();

bool IsNodeCharacter(char c)
{
    return NodeCharacters[static_cast<unsigned char>(c)];
}

}  // namespace

bool MatchesPattern(std::string_view pattern, std::string_view name)
{
    if (pattern == "*")
    {
        return true;  // asked for every message that is sent
    }
    std::size_t p = 0;
    std::size_t n = 0;
    std::size_t starAt = std::string_view::npos;
    std::size_t nameAtStar = 0;
    while (n < name.size())
    {
        if (p < pattern.size() && pattern[p] == '*')
        {
            starAt = p++;
            nameAtStar = n;
        }
        else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n]))
        {
            ++p;
            ++n;
        }
        else if (starAt != std::string_view::npos)
        {
            // Let the last star take one character more.
            p = starAt + 1;
            n = ++nameAtStar;
        }
        else
        {
            return false;
        }
    }
    return std::all_of(pattern.begin() + static_cast<std::ptrdiff_t>(p), pattern.end(),
                       [](char c) { return c == '*'; });
}

bool CoversPattern(std::string_view wider, std::string_view pattern)
{
    // `Strange` is in no pattern, so only wildcards match it. Each `*` of `pattern` is tried empty, and as
    // more `Strange` characters than `wider` is long: only a `*` of `wider` matches these.
    constexpr char Strange = '\x01';
    const auto withStarsAs = [pattern](std::size_t length)
    {
        std::string name;
        for (const char c : pattern)
        {
            name.append(c == '*' ? length : 1, c == '*' || c == '?' ? Strange : c);
        }
        return name;
    };
    return MatchesPattern(wider, withStarsAs(0)) && MatchesPattern(wider, withStarsAs(wider.size() + 1));
}

bool MatchesAny(const std::vector<std::string> &patterns, std::string_view name)
{
    return std::any_of(patterns.begin(), patterns.end(),
                       [name](const std::string &pattern) { return MatchesPattern(pattern, name); });
}

bool IsNodeName(std::string_view text)
{
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), IsNodeCharacter);
}

bool IsNodePattern(std::string_view text)
{
    return !text.empty() && text.size() <= 64 &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return IsNodeCharacter(c) || c == '*' || c == '?'; });
}

bool IsMessageName(std::string_view text)
{
    if (text.empty() || text.size() > 200 || text.back() == '/')
    {
        return false;
    }
    char before = '/';
    for (const char c : text)
    {
        if (!IsNodeCharacter(c) && c != ':' && (c != '/' || before == '/'))
        {
            return false;
        }
        before = c;
    }
    return true;
}

}  // namespace Rabit
