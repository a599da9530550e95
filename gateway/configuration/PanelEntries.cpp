#include "configuration/PanelEntries.h"

#include <string>
#include <vector>

namespace Rabit
{
namespace
{

struct Schema
{
    PanelRule::Panel Panel;
    std::string Name;
    std::vector<std::string> Needed;
    std::vector<std::string> Possible;
};

const std::vector<Schema> &Schemas()
{
    static const std::vector<Schema> schemas = {
        {PanelRule::Panel::LocationFix,
         "foxglove.LocationFix",
         {"latitude", "longitude"},
         {"altitude", "frame_id"}},
        {PanelRule::Panel::CompressedImage, "foxglove.CompressedImage", {"data", "format"}, {"frame_id"}},
        {PanelRule::Panel::Log, "foxglove.Log", {"message"}, {"name", "level"}},
    };
    return schemas;
}

const Schema &SchemaOf(const YamlMap &entry)
{
    std::vector<std::string> names;
    for (const Schema &schema : Schemas())
    {
        names.push_back(schema.Name);
    }
    return Schemas()[static_cast<std::size_t>(entry.ReadChoice("as", names))];
}

}  // namespace

void ReadPanels(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : map.Maps("foxglove", "a `foxglove` entry", {"message", "as", "fields"}))
    {
        for (const char *key : {"message", "as", "fields"})
        {
            entry.Require(key);
        }
        PanelRule rule;
        rule.Line = entry.Line();
        entry.Read("message", rule.Message);
        const Schema &schema = SchemaOf(entry);
        rule.Schema = schema.Panel;
        std::vector<std::string> keys = schema.Needed;
        keys.insert(keys.end(), schema.Possible.begin(), schema.Possible.end());
        const auto fields = entry.Map("fields", "`fields` of " + schema.Name, keys);
        for (const std::string &key : schema.Needed)
        {
            fields->Require(key);
        }
        for (const auto &[key, line] : fields->Lines())
        {
            fields->Read(key, rule.Fields[key]);
        }
        config.Panels.push_back(std::move(rule));
    }
}

}  // namespace Rabit
