#include "configuration/PanelEntries.h"

#include <cstddef>
#include <string>
#include <vector>

#include "configuration/ConfigSections.h"

namespace Rabit
{
namespace
{

// In the order of PanelRule::Panel.
const std::vector<std::string> Schemas = {"foxglove.LocationFix", "foxglove.CompressedImage", "foxglove.Log"};

}  // namespace

void ReadPanels(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : map.Maps("foxglove", ConfigSectionAt("foxglove")))
    {
        PanelRule rule;
        rule.Line = entry.Line();
        entry.Read("message", rule.Message);
        entry.Read("as", Schemas, rule.Schema);
        const auto fields =
            entry.Map("fields", ConfigSectionAt(Schemas.at(static_cast<std::size_t>(rule.Schema))));
        for (const std::string &key : fields->Keys())
        {
            fields->Read(key, rule.Fields[key]);
        }
        config.Panels.push_back(std::move(rule));
    }
}

}  // namespace Rabit
