#include "configuration/ParameterSection.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/NodeParameters.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace Rabit
{

struct NodeParametersSection
{
    explicit NodeParametersSection(YamlMap map) : Map(std::move(map)) {}

    static NodeParameters Of(YamlMap map)
    {
        NodeParameters parameters;
        parameters._section = std::make_shared<NodeParametersSection>(std::move(map));
        return parameters;
    }

    const YamlMap Map;
    std::vector<std::string> Known;  // the names that the program has read
    bool AllowsOthers = false;
};

namespace
{

// Returns the shortest digits that are this number, whatever the locale.
std::string Text(double value)
{
    char text[32];
    return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

}  // namespace

void ReadParameters(const YamlMap &map, GatewayConfig &config)
{
    if (auto section = map.MapOfAnyKeys("parameters", "the section `parameters`"))
    {
        config.Parameters = NodeParametersSection::Of(*std::move(section));
    }
}

bool NodeParameters::Has(const std::string &name) const
{
    if (!_section)
    {
        return false;
    }
    _section->Known.push_back(name);
    return _section->Map.Has(name);
}

void NodeParameters::Read(const std::string &name, std::string &value) const
{
    if (Has(name))
    {
        _section->Map.Read(name, value);
    }
}

void NodeParameters::Read(const std::string &name, bool &value) const
{
    if (Has(name))
    {
        _section->Map.Read(name, value);
    }
}

void NodeParameters::Read(const std::string &name, double &value, double least, double most) const
{
    if (!Has(name))
    {
        return;
    }
    double read = value;
    _section->Map.Read(name, read);
    if (read < least || read > most)
    {
        std::string text;
        _section->Map.Read(name, text);
        Fail(name,
             "`" + name + "` is `" + text + "`; expected a number from " + Text(least) + " to " + Text(most));
    }
    value = read;
}

void NodeParameters::Read(const std::string &name, int &value, int least, int most) const
{
    if (Has(name))
    {
        _section->Map.Read(name, value, least, most);
    }
}

void NodeParameters::Read(const std::string &name, std::chrono::milliseconds &value) const
{
    if (Has(name))
    {
        _section->Map.Read(name, value);
    }
}

void NodeParameters::Read(const std::string &name, std::vector<std::string> &value) const
{
    if (Has(name))
    {
        _section->Map.Read(name, value);
    }
}

void NodeParameters::Fail(const std::string &name, const std::string &message) const
{
    if (!_section)
    {
        throw ConfigError(message);
    }
    _section->Map.Fail(_section->Map.Line(name), message);
}

void NodeParameters::AllowOthers() const
{
    if (_section)
    {
        _section->AllowsOthers = true;
    }
}

void NodeParameters::RefuseOthers() const
{
    if (!_section || _section->AllowsOthers)
    {
        return;
    }
    for (const std::string &name : _section->Map.Keys())
    {
        const std::vector<std::string> &known = _section->Known;
        if (std::find(known.begin(), known.end(), name) == known.end())
        {
            _section->Map.Fail(_section->Map.Line(name), "unknown parameter `" + name + "`" +
                                                             (known.empty() ? "; this program reads none"
                                                                            : NearestWordHint(name, known)));
        }
    }
}

}  // namespace Rabit
