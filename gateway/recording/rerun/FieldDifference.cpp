#include "recording/rerun/FieldDifference.h"

#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace Rabit::Rerun
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t MostText = 400;

std::string Cut(std::string text)
{
    if (text.size() > MostText)
    {
        text.resize(MostText);
        text += "...";
    }
    return text;
}

std::string TextOf(const Json &json)
{
    return Cut(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

std::string Elements(std::size_t count)
{
    return std::to_string(count) + (count == 1 ? " element" : " elements");
}

std::optional<FieldDifference> Compare(const std::string &field, const Json &recorded, const Json &computed)
{
    if (recorded.is_object() && computed.is_object())
    {
        for (const auto &[key, value] : recorded.items())
        {
            const auto other = computed.find(key);
            const std::string name = field.empty() ? key : field + "." + key;
            if (other == computed.end())
            {
                return FieldDifference{name, TextOf(value), "nothing"};
            }
            if (auto difference = Compare(name, value, *other))
            {
                return difference;
            }
        }
        if (recorded.size() == computed.size())
        {
            return std::nullopt;
        }
    }
    else if (recorded.is_array() && computed.is_array())
    {
        for (std::size_t i = 0; i < std::min(recorded.size(), computed.size()); ++i)
        {
            if (auto difference = Compare(field + "[" + std::to_string(i) + "]", recorded[i], computed[i]))
            {
                return difference;
            }
        }
        if (recorded.size() == computed.size())
        {
            return std::nullopt;
        }
        return FieldDifference{field, Elements(recorded.size()), Elements(computed.size())};
    }
    if (recorded == computed)
    {
        return std::nullopt;
    }
    return FieldDifference{field, TextOf(recorded), TextOf(computed)};
}

std::optional<Json> ValueOf(const std::string &type, const std::vector<std::uint8_t> &sample)
{
    const MessageType *known = MessageTypeRegistry::Find(type);
    const auto parsed = known == nullptr ? nullptr : DynamicType::Parse(known->IdlText(), type).Type;
    const auto text = parsed ? parsed->ToJson(sample) : std::nullopt;
    if (!text)
    {
        return std::nullopt;
    }
    Json json = Json::parse(*text, nullptr, false);
    return json.is_discarded() ? std::nullopt : std::optional(std::move(json));
}

}  // namespace

FieldDifference FirstDifference(const std::string &type, const std::vector<std::uint8_t> &recorded,
                                const std::vector<std::uint8_t> &computed)
{
    const auto before = ValueOf(type, recorded);
    const auto now = ValueOf(type, computed);
    if (before && now)
    {
        if (auto difference = Compare("", *before, *now))
        {
            return *difference;
        }
    }
    return {"", JsonOf(type, recorded), JsonOf(type, computed)};
}

std::string JsonOf(const std::string &type, const std::vector<std::uint8_t> &sample)
{
    if (sample.empty())
    {
        return "nothing";
    }
    const auto value = ValueOf(type, sample);
    return value ? TextOf(*value) : std::to_string(sample.size()) + " bytes";
}

}  // namespace Rabit::Rerun
