#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace Rabit
{
namespace
{

char Lower(char c)
{
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::size_t EditDistance(const std::string &a, const std::string &b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
            const std::size_t substituted = diagonal + (Lower(a[i - 1]) == Lower(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

std::string NearestWordHint(const std::string &word, const std::vector<std::string> &candidates)
{
    // Longer words are not compared: the distance takes quadratic time, and a file may hold words of
    // megabytes.
    constexpr std::size_t longest = 200;
    const std::string *best = nullptr;
    std::size_t bestDistance = longest;
    if (word.size() <= longest)
    {
        for (const std::string &candidate : candidates)
        {
            const std::size_t distance = EditDistance(word, candidate);
            if (distance < bestDistance)
            {
                best = &candidate;
                bestDistance = distance;
            }
        }
    }
    if (best != nullptr && bestDistance <= std::max<std::size_t>(1, best->size() / 3))
    {
        return "; did you mean `" + *best + "`?";
    }
    if (candidates.empty() || candidates.size() > 10)
    {
        return "";
    }
    std::string hint = "; expected ";
    hint += candidates.size() > 1 ? "one of " : "";
    for (std::size_t i = 0; i < candidates.size(); ++i)
    {
        hint += (i > 0 ? ", `" : "`") + candidates[i] + "`";
    }
    return hint;
}

}  // namespace Rabit
