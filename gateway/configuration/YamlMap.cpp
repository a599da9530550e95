#include "configuration/YamlMap.h"

#include <rabit/base/NumberIn.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Rabit
{
namespace
{

int LineOf(const YAML::Node &node)
{
    return node.Mark().line + 1;
}

std::string WithoutScope(const std::string &type)
{
    return type.starts_with("::") ? type.substr(2) : type;
}

}  // namespace

YamlMap::YamlMap(std::string file, const YAML::Node &node, const ConfigSection &section)
    : YamlMap(std::move(file), node, section.Title, &section)
{
}

YamlMap::YamlMap(std::string file, const YAML::Node &node, std::string what)
    : YamlMap(std::move(file), node, std::move(what), nullptr)
{
}

YamlMap::YamlMap(std::string file, const YAML::Node &node, std::string what, const ConfigSection *section)
    : _file(std::move(file)), _what(std::move(what)), _line(LineOf(node))
{
    if (!node.IsMap())
    {
        Fail(_line, _what + " must be a mapping of keys to values");
    }
    const std::vector<std::string> allowedKeys = section ? section->Names() : std::vector<std::string>();
    for (const auto &entry : node)
    {
        if (!entry.first.IsScalar())
        {
            Fail(LineOf(entry.first), "a key in " + _what + " must be a word");
        }
        const std::string &key = entry.first.Scalar();
        if (section && std::find(allowedKeys.begin(), allowedKeys.end(), key) == allowedKeys.end())
        {
            Fail(LineOf(entry.first),
                 "unknown key `" + key + "` in " + _what + NearestWordHint(key, allowedKeys));
        }
        if (Has(key))
        {
            Fail(LineOf(entry.first), "key `" + key + "` stands twice in " + _what);
        }
        if (entry.second.IsNull())
        {
            Fail(LineOf(entry.first), "key `" + key + "` in " + _what + " has no value");
        }
        _entries.emplace_back(key, entry.second);
    }
    for (const ConfigKey &key : section ? section->Keys : std::vector<ConfigKey>())
    {
        if (key.IsRequired)
        {
            Require(key.Name);
        }
    }
}

const YAML::Node *YamlMap::Find(const std::string &key) const
{
    const auto found = std::find_if(_entries.begin(), _entries.end(),
                                    [&key](const auto &entry) { return entry.first == key; });
    return found == _entries.end() ? nullptr : &found->second;
}

bool YamlMap::Has(const std::string &key) const
{
    return Find(key) != nullptr;
}

std::vector<std::string> YamlMap::Keys() const
{
    std::vector<std::string> keys;
    for (const auto &[key, value] : _entries)
    {
        keys.push_back(key);
    }
    return keys;
}

int YamlMap::Line(const std::string &key) const
{
    const YAML::Node *node = Find(key);
    return node == nullptr ? _line : LineOf(*node);
}

std::map<std::string, int> YamlMap::Lines() const
{
    std::map<std::string, int> lines;
    for (const auto &[key, value] : _entries)
    {
        lines[key] = LineOf(value);
    }
    return lines;
}

void YamlMap::Fail(int line, const std::string &message) const
{
    throw ConfigError(_file, line, message);
}

void YamlMap::Require(const std::string &key) const
{
    if (!Has(key))
    {
        Fail(_line, _what + " needs the key `" + key + "`");
    }
}

const std::string &YamlMap::Scalar(const YAML::Node &node, const std::string &key, const char *expected) const
{
    if (!node.IsScalar() || node.Scalar().empty())
    {
        Fail(LineOf(node), "`" + key + "` must be " + expected);
    }
    return node.Scalar();
}

void YamlMap::Read(const std::string &key, std::string &value) const
{
    if (const YAML::Node *node = Find(key))
    {
        value = Scalar(*node, key, "a word");
    }
}

void YamlMap::Read(const std::string &key, bool &value) const
{
    const int choice = ReadChoice(key, {"off", "on", "false", "true"});
    value = choice < 0 ? value : choice % 2 == 1;
}

void YamlMap::Read(const std::string &key, double &value) const
{
    if (const YAML::Node *node = Find(key))
    {
        const std::string &text = Scalar(*node, key, "a number");
        const auto number = NumberIn<double>(text);
        if (!number || !std::isfinite(*number))
        {
            Fail(LineOf(*node), "`" + key + "` is `" + text + "`; expected a number");
        }
        value = *number;
    }
}

template <typename Number>
void YamlMap::ReadWhole(const std::string &key, Number &value, Number least, Number most) const
{
    if (const YAML::Node *node = Find(key))
    {
        const std::string &text = Scalar(*node, key, "a whole number");
        const auto number = NumberIn<Number>(text);
        if (!number || *number < least || *number > most)
        {
            Fail(LineOf(*node), "`" + key + "` is `" + text + "`; expected a whole number from " +
                                    std::to_string(least) + " to " + std::to_string(most));
        }
        value = *number;
    }
}

void YamlMap::Read(const std::string &key, int &value, int least, int most) const
{
    ReadWhole(key, value, least, most);
}

void YamlMap::Read(const std::string &key, std::size_t &value, std::size_t least, std::size_t most) const
{
    ReadWhole(key, value, least, most);
}

void YamlMap::Read(const std::string &key, std::chrono::milliseconds &value) const
{
    const YAML::Node *node = Find(key);
    if (node == nullptr)
    {
        return;
    }
    const std::string &text = Scalar(*node, key, "a time such as 5s or 200ms");
    const std::size_t unitAt = text.find_first_not_of("0123456789.");
    double milliseconds = -1.0;
    if (const auto number = NumberIn<double>(text.substr(0, unitAt)); number && unitAt != std::string::npos)
    {
        const std::string unit = text.substr(unitAt);
        milliseconds = unit == "ms"    ? *number
                       : unit == "s"   ? *number * 1e3
                       : unit == "min" ? *number * 6e4
                                       : -1.0;
    }
    // A year is longer than anything that is timed here, and far from overflowing.
    if (milliseconds < 0.0 || milliseconds > 365.0 * 86400e3)
    {
        Fail(LineOf(*node), "`" + key + "` is `" + text + "`; expected a time such as 5s, 200ms or 2min");
    }
    value = std::chrono::milliseconds(std::llround(milliseconds));
}

void YamlMap::ReadByteRate(const std::string &key, std::optional<double> &value) const
{
    const YAML::Node *node = Find(key);
    if (node == nullptr)
    {
        return;
    }
    const std::string &text = Scalar(*node, key, "auto, or bytes a second such as 1500B/s or 5kB/s");
    value.reset();
    if (text == "auto")
    {
        return;
    }
    const std::size_t unitAt = std::min(text.find_first_not_of("0123456789."), text.size());
    const std::string unit = text.substr(unitAt);
    const double factor = unit == "B/s" ? 1.0 : unit == "kB/s" ? 1e3 : unit == "MB/s" ? 1e6 : 0.0;
    const auto number = NumberIn<double>(text.substr(0, unitAt));
    if (factor == 0.0 || !number || !std::isfinite(*number))
    {
        Fail(LineOf(*node),
             "`" + key + "` is `" + text + "`; expected auto, or bytes a second such as 1500B/s or 5kB/s");
    }
    value = *number * factor;
}

void YamlMap::ReadByteSize(const std::string &key, std::uint64_t &value, const ByteRange &range) const
{
    const YAML::Node *node = Find(key);
    if (node == nullptr)
    {
        return;
    }
    const std::string &text = Scalar(*node, key, "bytes such as 64MB or 1GB");
    try
    {
        value = ParseByteSize(text, range);
    }
    catch (const std::invalid_argument &error)
    {
        Fail(LineOf(*node), "`" + key + "` is `" + text + "`; " + error.what());
    }
}

void YamlMap::Read(const std::string &key, std::vector<std::string> &value) const
{
    const YAML::Node *node = Find(key);
    if (node == nullptr)
    {
        return;
    }
    value.clear();
    if (!node->IsSequence())
    {
        value.push_back(Scalar(*node, key, "a list of words"));
        return;
    }
    for (const auto &item : *node)
    {
        value.push_back(Scalar(item, key, "a list of words"));
    }
}

void YamlMap::ReadType(const std::string &key, std::string &value) const
{
    Read(key, value);
    value = WithoutScope(value);
}

void YamlMap::ReadTypes(const std::string &key, std::vector<std::string> &value) const
{
    Read(key, value);
    std::transform(value.begin(), value.end(), value.begin(), WithoutScope);
}

int YamlMap::ReadChoice(const std::string &key, const std::vector<std::string> &choices) const
{
    const YAML::Node *node = Find(key);
    if (node == nullptr)
    {
        return -1;
    }
    const std::string &text = Scalar(*node, key, "a word");
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found == choices.end())
    {
        Fail(LineOf(*node), "`" + key + "` is `" + text + "`" + NearestWordHint(text, choices));
    }
    return static_cast<int>(found - choices.begin());
}

std::optional<YamlMap> YamlMap::Map(const std::string &key, const ConfigSection &section) const
{
    const YAML::Node *node = Find(key);
    return node == nullptr ? std::nullopt : std::optional(YamlMap(_file, *node, section));
}

std::optional<YamlMap> YamlMap::MapOfAnyKeys(const std::string &key, const std::string &what) const
{
    const YAML::Node *node = Find(key);
    return node == nullptr ? std::nullopt : std::optional(YamlMap(_file, *node, what));
}

std::vector<YamlMap> YamlMap::Maps(const std::string &key, const ConfigSection &section) const
{
    std::vector<YamlMap> maps;
    if (const YAML::Node *node = Find(key))
    {
        if (!node->IsSequence())
        {
            Fail(LineOf(*node), "`" + key + "` must be a list; each entry starts with `- `");
        }
        for (const auto &item : *node)
        {
            maps.emplace_back(_file, item, section);
        }
    }
    return maps;
}

}  // namespace Rabit
