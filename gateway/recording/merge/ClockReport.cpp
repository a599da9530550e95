#include "recording/merge/ClockReport.h"

#include <rabit/base/NumberIn.h>

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace Rabit::Merge
{
namespace
{

using Json = nlohmann::ordered_json;

// The functions that read throw an exception if something is missing or of another kind.

// 64-bit numbers are texts, for readers that know floating point alone.
template <typename Number>
Number NumberOf(const Json &json, const char *member)
{
    return NumberIn<Number>(json.at(member).get_ref<const std::string &>()).value();
}

Moment ShiftOf(const Json &json)
{
    const auto shift = NumberOf<Moment>(json, "source_to_log_ns");
    return Within(shift) == shift ? shift : throw std::out_of_range("too far");
}

void AddPeer(const Json &json, ClockReport &report)
{
    try
    {
        ClockReport::Peer peer{json.at("node"), NumberOf<std::uint64_t>(json, "incarnation"), ShiftOf(json),
                               std::nullopt};
        if (const Json uncertain = json.value("uncertain_by_ns", Json()); uncertain.is_number_integer())
        {
            const auto by = uncertain.get<Moment>();
            peer.UncertainBy = by >= 0 && by <= FarthestMoment ? std::optional(by) : std::nullopt;
        }
        report.Peers.push_back(std::move(peer));
    }
    catch (const std::exception &)
    {
        // Malformed peers are left out.
    }
}

void Shift(Json &json, Moment later)
{
    try
    {
        json["source_to_log_ns"] = std::to_string(ShiftOf(json) + later);
    }
    catch (const std::exception &)
    {
        // It tells no shift.
    }
}

}  // namespace

std::optional<ClockReport> ReadClockReport(Mcap::ByteView json)
{
    try
    {
        const Json object = Json::parse(json.begin(), json.end());
        ClockReport report{NumberOf<std::uint64_t>(object, "incarnation"), ShiftOf(object), {}};
        for (const Json &peer : object.value("peers", Json::array()))
        {
            AddPeer(peer, report);
        }
        return report;
    }
    catch (const std::exception &)
    {
        return std::nullopt;
    }
}

std::optional<Mcap::Bytes> ShiftClockReport(Mcap::ByteView json, Moment later)
{
    Json object = Json::parse(json.begin(), json.end(), nullptr, false);
    if (!object.is_object())
    {
        return std::nullopt;
    }
    Shift(object, later);
    if (object.contains("peers"))
    {
        for (Json &peer : object["peers"])
        {
            Shift(peer, later);
        }
    }
    const std::string text = object.dump(-1, ' ', true, Json::error_handler_t::replace);
    return Mcap::Bytes(text.begin(), text.end());
}

}  // namespace Rabit::Merge
