#include "recording/rerun/StepText.h"

#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cstddef>

namespace Rabit::Rerun
{
namespace
{

using Json = nlohmann::ordered_json;
using Kind = StepEvent::Kind;
using Step = RabitManagerTrace::Step;

constexpr std::array StepWords = {"startup", "unit of work", "shutdown"};
constexpr std::array KindWords = {"monotonic", "gps_time", "fetched", "posted",
                                  "taken",     "added",    "refused", "listed"};

std::string HexOf(const std::vector<std::uint8_t> &bytes)
{
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes)
    {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

bool ReadHex(const std::string &text, std::vector<std::uint8_t> &bytes)
{
    bytes.resize(text.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        const char *const digits = text.data() + 2 * i;
        if (std::from_chars(digits, digits + 2, bytes[i], 16).ptr != digits + 2)
        {
            return false;
        }
    }
    return text.size() % 2 == 0;
}

template <typename Number>
bool ReadNumber(const Json &json, const char *key, Number &number)
{
    const auto found = json.find(key);
    if (found == json.end() || !found->is_string())
    {
        return false;
    }
    const auto &text = found->get_ref<const std::string &>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

bool ReadTime(const Json &json, std::chrono::nanoseconds &time)
{
    std::int64_t count = 0;
    const bool good = ReadNumber(json, "monotonic_ns", count);
    time = std::chrono::nanoseconds(count);
    return good;
}

bool Read(const Json &json, const char *key, double &number)
{
    const auto found = json.find(key);
    const bool good = found != json.end() && found->is_number();
    number = good ? found->get<double>() : 0;
    return good;
}

bool Read(const Json &json, const char *key, std::string &text)
{
    const auto found = json.find(key);
    const bool good = found != json.end() && found->is_string();
    text = good ? found->get<std::string>() : "";
    return good;
}

// Returns false if the key is missing.
bool Flag(const Json &json, const char *key)
{
    const auto found = json.find(key);
    return found != json.end() && found->is_boolean() && found->get<bool>();
}

template <std::size_t Count>
std::optional<std::size_t> WordIn(const std::array<const char *, Count> &words, const Json &json,
                                  const char *key)
{
    std::string word;
    Read(json, key, word);
    for (std::size_t i = 0; i < Count; ++i)
    {
        if (word == words[i])
        {
            return i;
        }
    }
    return std::nullopt;
}

Json JsonOf(const StepEvent &event)
{
    Json json = {{"what", KindWords[static_cast<std::size_t>(event.What)]}};
    if (event.What == Kind::Monotonic)
    {
        json["monotonic_ns"] = std::to_string(event.Monotonic.count());
        return json;
    }
    if (event.What == Kind::GpsTime)
    {
        json["gps_time_s"] = event.GpsTime;
        return json;
    }
    if (event.What == Kind::Listed)
    {
        Json names = Json::array();
        for (const auto &[name, type] : event.Names)
        {
            names.push_back({{"name", name}, {"type", type}});
        }
        json["names"] = std::move(names);
        return json;
    }
    json["name"] = event.Name;
    json["type"] = event.Type;
    if (event.What == Kind::Fetched || event.What == Kind::Posted)
    {
        json["number"] = std::to_string(event.Number);
    }
    if (event.What == Kind::Fetched || event.What == Kind::Posted || event.What == Kind::Taken)
    {
        json["gps_time_s"] = event.GpsTime;
        if (event.WasPosted)
        {
            json["monotonic_ns"] = std::to_string(event.Monotonic.count());
        }
    }
    if (event.IsRedelivered)
    {
        json["redelivered"] = true;
    }
    json["sample"] = HexOf(event.Sample);
    return json;
}

bool ReadNames(const Json &json, StepEvent &event)
{
    const auto names = json.find("names");
    if (names == json.end() || !names->is_array())
    {
        return false;
    }
    for (const Json &one : *names)
    {
        auto &[name, type] = event.Names.emplace_back();
        if (!one.is_object() || !Read(one, "name", name) || !Read(one, "type", type))
        {
            return false;
        }
    }
    return true;
}

bool ReadEvent(const Json &json, StepEvent &event)
{
    const auto kind = json.is_object() ? WordIn(KindWords, json, "what") : std::nullopt;
    if (!kind)
    {
        return false;
    }
    event.What = static_cast<Kind>(*kind);
    switch (event.What)
    {
        case Kind::Monotonic:
            return ReadTime(json, event.Monotonic);
        case Kind::GpsTime:
            return Read(json, "gps_time_s", event.GpsTime);
        case Kind::Listed:
            return ReadNames(json, event);
        default:
            break;
    }
    const bool isPost = event.What == Kind::Fetched || event.What == Kind::Posted;
    if (isPost && !ReadNumber(json, "number", event.Number))
    {
        return false;
    }
    Read(json, "gps_time_s", event.GpsTime);
    event.WasPosted = ReadTime(json, event.Monotonic);
    event.IsRedelivered = Flag(json, "redelivered");
    std::string sample;
    return Read(json, "name", event.Name) && Read(json, "type", event.Type) && Read(json, "sample", sample) &&
           ReadHex(sample, event.Sample);
}

}  // namespace

std::string TextOf(const ManagerStep &step)
{
    Json events = Json::array();
    for (const StepEvent &event : step.Events)
    {
        events.push_back(JsonOf(event));
    }
    const Json json = {{"step", StepWords[static_cast<std::size_t>(step.What)]},
                       {"number", std::to_string(step.Number)},
                       {"turn", step.IsTurn},
                       {"threw", step.Threw},
                       {"monotonic_ns", std::to_string(step.Began.count())},
                       {"gps_time_s", step.BeganGpsTime},
                       {"events", std::move(events)}};
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::optional<ManagerStep> StepOf(std::string_view text)
{
    const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
    const auto what = json.is_object() ? WordIn(StepWords, json, "step") : std::nullopt;
    ManagerStep step;
    if (!what || !ReadNumber(json, "number", step.Number) || !ReadTime(json, step.Began) ||
        !Read(json, "gps_time_s", step.BeganGpsTime))
    {
        return std::nullopt;
    }
    step.What = static_cast<Step>(*what);
    step.IsTurn = Flag(json, "turn");
    step.Threw = Flag(json, "threw");
    const auto events = json.find("events");
    if (events == json.end() || !events->is_array())
    {
        return std::nullopt;
    }
    for (const Json &event : *events)
    {
        if (!ReadEvent(event, step.Events.emplace_back()))
        {
            return std::nullopt;
        }
    }
    return step;
}

const char *StepSchema()
{
    return R"({"type":"object","properties":{
"step":{"type":"string","description":"startup, unit of work or shutdown"},
"number":{"type":"string","description":"0 is the startup"},
"turn":{"type":"boolean"},"threw":{"type":"boolean"},
"monotonic_ns":{"type":"string","description":"when it began"},"gps_time_s":{"type":"number"},
"events":{"type":"array","description":"what it read and did","items":{"type":"object","properties":{
"what":{"type":"string","description":"monotonic, gps_time, fetched, posted, taken, added, refused or listed"},
"name":{"type":"string"},"type":{"type":"string"},
"number":{"type":"string","description":"the number of this post among all posts of that message"},
"monotonic_ns":{"type":"string"},"gps_time_s":{"type":"number"},"redelivered":{"type":"boolean"},
"sample":{"type":"string","description":"CDR in hexadecimal digits; empty: the post that was fetched before"},
"names":{"type":"array","items":{"type":"object","properties":{
"name":{"type":"string"},"type":{"type":"string"}}}}}}}}})";
}

}  // namespace Rabit::Rerun
