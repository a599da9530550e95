#include "recording/rerun/StepText.h"

#include <rabit/base/NumberIn.h>

#include <boost/algorithm/hex.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <stdexcept>

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

// The functions that read throw an exception if the text is not of that kind.

template <typename Number>
Number NumberOf(const Json &json)
{
    return NumberIn<Number>(json.get_ref<const std::string &>()).value();
}

std::chrono::nanoseconds TimeIn(const Json &json)
{
    return std::chrono::nanoseconds(NumberOf<std::int64_t>(json));
}

// Returns the value of that name, whose index is the same.
template <typename Value, std::size_t Count>
Value ValueIn(const Json &json, const std::array<const char *, Count> &words)
{
    const auto found = std::find(words.begin(), words.end(), json.get_ref<const std::string &>());
    if (found == words.end())
    {
        throw std::invalid_argument("not one of the words");
    }
    return static_cast<Value>(found - words.begin());
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
    std::string sample;
    boost::algorithm::hex_lower(event.Sample, std::back_inserter(sample));
    json["sample"] = std::move(sample);
    return json;
}

StepEvent EventIn(const Json &json)
{
    StepEvent event;
    event.What = ValueIn<Kind>(json.at("what"), KindWords);
    switch (event.What)
    {
        case Kind::Monotonic:
            event.Monotonic = TimeIn(json.at("monotonic_ns"));
            return event;
        case Kind::GpsTime:
            event.GpsTime = json.at("gps_time_s").get<double>();
            return event;
        case Kind::Listed:
            for (const Json &one : json.at("names").get_ref<const Json::array_t &>())
            {
                event.Names.emplace_back(one.at("name"), one.at("type"));
            }
            return event;
        case Kind::Fetched:
        case Kind::Posted:
            event.Number = NumberOf<std::uint64_t>(json.at("number"));
            break;
        default:
            break;
    }
    const Json gpsTime = json.value("gps_time_s", Json());
    event.GpsTime = gpsTime.is_number() ? gpsTime.get<double>() : 0;  // null: it was not finite
    event.WasPosted = json.contains("monotonic_ns");
    event.Monotonic = event.WasPosted ? TimeIn(json["monotonic_ns"]) : event.Monotonic;
    event.IsRedelivered = json.value("redelivered", false);
    event.Name = json.at("name");
    event.Type = json.at("type");
    boost::algorithm::unhex(json.at("sample").get_ref<const std::string &>(),
                            std::back_inserter(event.Sample));
    return event;
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
    try
    {
        const Json json = Json::parse(text);
        ManagerStep step;
        step.What = ValueIn<Step>(json.at("step"), StepWords);
        step.Number = NumberOf<std::uint64_t>(json.at("number"));
        step.Began = TimeIn(json.at("monotonic_ns"));
        step.BeganGpsTime = json.at("gps_time_s").get<double>();
        step.IsTurn = json.value("turn", false);
        step.Threw = json.value("threw", false);
        for (const Json &event : json.at("events").get_ref<const Json::array_t &>())
        {
            step.Events.push_back(EventIn(event));
        }
        return step;
    }
    catch (const std::exception &)
    {
        return std::nullopt;
    }
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
