#include "live/PanelMapping.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <map>
#include <string_view>
#include <utility>

#include "JsonText.h"

namespace Rabit::Tool
{
namespace
{

using Json = nlohmann::ordered_json;
using Panel = PanelRule::Panel;

struct Member
{
    std::string_view Name;
    bool IsNumber = false;
};

// https://docs.foxglove.dev/docs/sdk/schemas
struct Schema
{
    std::string_view Name;
    std::vector<Member> Members;  // without timestamp, which all have
};

const Schema &SchemaOf(Panel panel)
{
    static const std::map<Panel, Schema> schemas = {
        {Panel::LocationFix,
         {"LocationFix", {{"frame_id", false}, {"latitude", true}, {"longitude", true}, {"altitude", true}}}},
        {Panel::CompressedImage,
         {"CompressedImage", {{"frame_id", false}, {"data", false}, {"format", false}}}},
        {Panel::Log, {"Log", {{"level", true}, {"message", false}, {"name", false}}}},
    };
    return schemas.at(panel);
}

std::string JsonSchemaOf(Panel panel)
{
    const Json integer = {{"type", "integer"}};
    Json members = {
        {"timestamp",
         {{"type", "object"}, {"title", "time"}, {"properties", {{"sec", integer}, {"nsec", integer}}}}}};
    for (const Member &member : SchemaOf(panel).Members)
    {
        Json &type = members[std::string(member.Name)];
        type["type"] = member.IsNumber ? "number" : "string";
        if (panel == Panel::CompressedImage && member.Name == "data")
        {
            type["contentEncoding"] = "base64";
        }
    }
    const std::string name = "foxglove." + std::string(SchemaOf(panel).Name);
    return Json{{"title", name}, {"type", "object"}, {"properties", std::move(members)}}.dump();
}

LiveProtocol::Channel ChannelOf(Panel panel, std::string topic)
{
    LiveProtocol::Channel channel;
    channel.Topic = std::move(topic);
    channel.Encoding = "json";
    channel.SchemaName = "foxglove." + std::string(SchemaOf(panel).Name);
    channel.SchemaEncoding = "jsonschema";
    channel.SchemaText = JsonSchemaOf(panel);
    return channel;
}

Json TimeOf(std::uint64_t nanoseconds)
{
    constexpr std::uint64_t second = 1'000'000'000;
    return {{"sec", nanoseconds / second}, {"nsec", nanoseconds % second}};
}

// Follows a path as `a.b.0`; null if it leads nowhere.
const Json *Follow(std::string_view path, const Json *value)
{
    while (value != nullptr && !path.empty())
    {
        const std::size_t dot = std::min(path.find('.'), path.size());
        const std::string step(path.substr(0, dot));
        path.remove_prefix(std::min(dot + 1, path.size()));
        if (value->is_array())
        {
            std::size_t index = value->size();
            std::from_chars(step.data(), step.data() + step.size(), index);
            value = index < value->size() ? &(*value)[index] : nullptr;
        }
        else
        {
            value = value->is_object() && value->contains(step) ? &(*value)[step] : nullptr;
        }
    }
    return value;
}

Json TextOf(const Json &value)
{
    return value.is_string() ? value : Json(value.dump());
}

struct Shown
{
    Json What;
    std::string Problem;
};

Shown ShownOf(const PanelRule &rule, const Json &value)
{
    Shown shown;
    for (const Member &member : SchemaOf(rule.Schema).Members)
    {
        const std::string name(member.Name);
        const auto rest = rule.Fields.find(name);
        if (rest == rule.Fields.end())
        {
            continue;
        }
        const std::string &where = rest->second;
        if (where.starts_with('='))
        {
            const std::string text = where.substr(1);
            shown.What[name] = member.IsNumber ? Json::parse(text, nullptr, false) : Json(text);
            if (member.IsNumber && !shown.What[name].is_number())
            {
                shown.Problem = "`" + text + "`, for `" + name + "`, is no number";
                return shown;
            }
            continue;
        }
        const Json *found = Follow(where, &value);
        if (found == nullptr || (member.IsNumber && !found->is_number()))
        {
            shown.Problem = found == nullptr ? "there is no `" + where + "` for `" + name + "`"
                                             : "`" + where + "`, for `" + name + "`, is no number";
            return shown;
        }
        shown.What[name] = member.IsNumber ? *found : TextOf(*found);
    }
    return shown;
}

}  // namespace

LiveProtocol::Channel PanelMapping::ChannelFor(const std::string &node) const
{
    return ChannelOf(_rule.Schema,
                     node + "/" + _rule.Message + "/" + std::string(SchemaOf(_rule.Schema).Name));
}

std::optional<std::string> PanelMapping::Show(const std::string &node, const std::string &value,
                                              std::uint64_t postedAt) const
{
    Shown shown = ShownOf(_rule, Json::parse(value, nullptr, false));
    if (!shown.Problem.empty())
    {
        return std::nullopt;
    }
    shown.What["timestamp"] = TimeOf(postedAt);
    const char *origin = _rule.Schema == Panel::Log ? "name" : "frame_id";
    if (!shown.What.contains(origin))
    {
        shown.What[origin] = node;
    }
    if (_rule.Schema == Panel::Log && !shown.What.contains("level"))
    {
        constexpr int info = 2;
        shown.What["level"] = info;
    }
    return JsonText(shown.What);
}

std::string PanelMapping::WhyNot(const std::string &value) const
{
    return ShownOf(_rule, Json::parse(value, nullptr, false)).Problem;
}

namespace PanelLog
{

LiveProtocol::Channel Channel()
{
    return ChannelOf(Panel::Log, "Gateway/Problems");
}

std::string Line(std::uint64_t time, int level, const std::string &name, const std::string &message)
{
    return JsonText({{"timestamp", TimeOf(time)}, {"level", level}, {"name", name}, {"message", message}});
}

}  // namespace PanelLog

}  // namespace Rabit::Tool
