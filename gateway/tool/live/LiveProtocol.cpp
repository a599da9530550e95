#include "live/LiveProtocol.h"

#include <rabit/base/LittleEndian.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <limits>

#include "JsonText.h"

namespace Rabit::Tool::LiveProtocol
{
namespace
{

using Json = nlohmann::ordered_json;

std::optional<std::uint32_t> NumberOf(const Json &value)
{
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    {
        return std::nullopt;
    }
    return static_cast<std::uint32_t>(value.get<std::uint64_t>());
}

std::optional<std::uint32_t> NumberOf(const Json &object, const char *member)
{
    return object.is_object() && object.contains(member) ? NumberOf(object[member]) : std::nullopt;
}

Request NotUnderstood(const std::string &why)
{
    Request request;
    request.Problem = why;
    return request;
}

Request ReadSubscribe(const Json &list)
{
    Request request;
    request.What = Request::Kind::Subscribe;
    for (const Json &one : list)
    {
        const auto id = NumberOf(one, "id");
        const auto channel = NumberOf(one, "channelId");
        if (!id || !channel)
        {
            return NotUnderstood("a subscription has an `id` and a `channelId`");
        }
        request.Subscriptions.push_back({*id, *channel});
    }
    return request;
}

Request ReadUnsubscribe(const Json &list)
{
    Request request;
    request.What = Request::Kind::Unsubscribe;
    for (const Json &one : list)
    {
        const auto id = NumberOf(one);
        if (!id)
        {
            return NotUnderstood("`subscriptionIds` are numbers");
        }
        request.Ids.push_back(*id);
    }
    return request;
}

}  // namespace

std::optional<std::string_view> ChosenOf(std::string_view asked)
{
    while (!asked.empty())
    {
        const std::size_t comma = std::min(asked.find(','), asked.size());
        std::string_view name = asked.substr(0, comma);
        name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
        name = name.substr(0, name.find_last_not_of(" \t") + 1);
        const auto found = std::find(std::begin(Names), std::end(Names), name);
        if (found != std::end(Names))
        {
            return *found;
        }
        asked.remove_prefix(std::min(comma + 1, asked.size()));
    }
    return std::nullopt;
}

std::string ServerInfo(const std::string &name, const std::string &session)
{
    return JsonText({{"op", "serverInfo"},
                     {"name", name},
                     {"capabilities", Json::array()},
                     {"supportedEncodings", Json::array()},
                     {"metadata", Json::object()},
                     {"sessionId", session}});
}

std::string Advertise(std::span<const Channel> channels)
{
    Json list = Json::array();
    for (const Channel &channel : channels)
    {
        list.push_back({{"id", channel.Id},
                        {"topic", channel.Topic},
                        {"encoding", channel.Encoding},
                        {"schemaName", channel.SchemaName},
                        {"schema", channel.SchemaText},
                        {"schemaEncoding", channel.SchemaEncoding}});
    }
    return JsonText({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string Status(Level level, const std::string &message, const std::string &id)
{
    Json status = {{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}};
    if (!id.empty())
    {
        status["id"] = id;
    }
    return JsonText(status);
}

std::vector<std::uint8_t> MessageData(std::uint32_t subscription, std::uint64_t time,
                                      std::span<const std::uint8_t> bytes)
{
    constexpr std::uint8_t opcode = 0x01;
    std::vector<std::uint8_t> frame(MessageDataHeader + bytes.size());
    frame[0] = opcode;
    LittleEndian::Write(subscription, &frame[1]);
    LittleEndian::Write(time, &frame[1 + sizeof subscription]);
    std::ranges::copy(bytes, frame.data() + MessageDataHeader);
    return frame;
}

Request ReadRequest(std::string_view text)
{
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("op") || !json["op"].is_string())
    {
        return NotUnderstood("that is no request of the protocol");
    }
    const std::string op = json["op"].get<std::string>();
    const auto listed = [&json](const char *member)
    { return json.contains(member) && json[member].is_array(); };
    if (op == "subscribe" && listed("subscriptions"))
    {
        return ReadSubscribe(json["subscriptions"]);
    }
    if (op == "unsubscribe" && listed("subscriptionIds"))
    {
        return ReadUnsubscribe(json["subscriptionIds"]);
    }
    return NotUnderstood("`" + op + "` is not had here: it can be looked at, and nothing can be sent");
}

}  // namespace Rabit::Tool::LiveProtocol
