#include "configuration/ConfigCheck.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <set>

namespace Rabit
{
namespace
{

std::string FirstIn(int line)
{
    return line > 0 ? " (first in line " + std::to_string(line) + ")" : "";
}

}  // namespace

void ConfigCheck::Fail(int line, const std::string &message) const
{
    throw ConfigError(_config.File, line, message);
}

int ConfigCheck::LineOf(const std::string &key) const
{
    const auto found = _config.Lines.find(key);
    return found == _config.Lines.end() ? 0 : found->second;
}

void ConfigCheck::CheckType(const std::string &type, int line) const
{
    const std::string why = _whyNoType(type);
    if (!why.empty())
    {
        Fail(line, why);
    }
}

void ConfigCheck::CheckPattern(const std::string &pattern, const char *key, int line) const
{
    if (!IsNodeName(WithoutWildcards(pattern)))
    {
        Fail(line,
             "`" + pattern + "` in `" + key + "` is no node name; `*` and `?` stand for any characters");
    }
}

void ConfigCheck::CheckPatterns(const std::vector<std::string> &patterns, const char *key, int line) const
{
    if (patterns.empty())
    {
        Fail(line, std::string("`") + key + "` is empty; expected node names, `*` and `?` stand for any");
    }
    for (const std::string &pattern : patterns)
    {
        CheckPattern(pattern, key, line);
    }
    CheckNoneTwice(patterns, key, line);
}

void ConfigCheck::CheckMessagePatterns(const std::vector<std::string> &patterns, const char *key, int line,
                                       const std::string &what) const
{
    for (const std::string &pattern : patterns)
    {
        if (!IsMessageName(WithoutWildcards(pattern)))
        {
            Fail(line, "`" + pattern + "` in `" + key + "` is no " + what +
                           "; `*` and `?` stand for any characters");
        }
    }
    CheckNoneTwice(patterns, key, line);
}

void ConfigCheck::CheckNoneTwice(const std::vector<std::string> &list, const char *key, int line) const
{
    std::set<std::string> seen;
    for (const std::string &entry : list)
    {
        if (!seen.insert(entry).second)
        {
            Fail(line, "`" + entry + "` stands twice under `" + key + "`");
        }
    }
}

void ConfigCheck::CheckOnce(std::map<std::string, int> &seen, const std::string &name, const char *list,
                            int line) const
{
    const auto [place, isNew] = seen.emplace(name, line);
    if (!isNew)
    {
        Fail(line, "`" + name + "` stands twice under `" + list + "`" + FirstIn(place->second));
    }
}

void ConfigCheck::CheckRange(std::size_t value, std::size_t most, const char *key, int line) const
{
    if (value < 1 || value > most)
    {
        Fail(line, std::string("`") + key + "` is out of range; expected 1 to " + std::to_string(most));
    }
}

void ConfigCheck::CheckMaxRate(double rate, int line) const
{
    if (!(rate >= 0.0 && rate <= 1e6))
    {
        Fail(line, "max_rate is out of range; expected 0 (no limit) to 1000000 a second");
    }
}

std::string ConfigCheck::WithoutWildcards(std::string pattern)
{
    std::replace_if(
        pattern.begin(), pattern.end(), [](char c) { return c == '*' || c == '?'; }, 'x');
    return pattern;
}

}  // namespace Rabit
