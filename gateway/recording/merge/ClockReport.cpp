#include "recording/merge/ClockReport.h"

#include <nlohmann/json.hpp>

#include <charconv>

namespace Rabit::Merge
{
namespace
{

using Json = nlohmann::ordered_json;

// 64-bit numbers are texts, for readers that know floating point alone.
template <typename Number>
std::optional<Number> NumberOf(const Json &json, const char *member)
{
    const auto found = json.find(member);
    if (found == json.end() || !found->is_string())
    {
        return std::nullopt;
    }
    const std::string &text = found->get_ref<const std::string &>();
    Number number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::optional<Moment> ShiftOf(const Json &json)
{
    const auto shift = NumberOf<Moment>(json, "source_to_log_ns");
    return shift && Within(*shift) == *shift ? shift : std::nullopt;
}

std::optional<Json> ObjectOf(Mcap::ByteView bytes)
{
    Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    return json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<ClockReport::Peer> PeerOf(const Json &json)
{
    if (!json.is_object())
    {
        return std::nullopt;
    }
    const auto node = json.find("node");
    const auto incarnation = NumberOf<std::uint64_t>(json, "incarnation");
    const auto shift = ShiftOf(json);
    if (node == json.end() || !node->is_string() || !incarnation || !shift)
    {
        return std::nullopt;
    }
    ClockReport::Peer peer{node->get<std::string>(), *incarnation, *shift, std::nullopt};
    const auto uncertain = json.find("uncertain_by_ns");
    if (uncertain != json.end() && uncertain->is_number_integer())
    {
        const auto by = uncertain->get<Moment>();
        peer.UncertainBy = by >= 0 && by <= FarthestMoment ? std::optional(by) : std::nullopt;
    }
    return peer;
}

void Shift(Json &json, Moment later)
{
    if (const auto shift = ShiftOf(json))
    {
        json["source_to_log_ns"] = std::to_string(*shift + later);
    }
}

}  // namespace

std::optional<ClockReport> ReadClockReport(Mcap::ByteView json)
{
    const auto object = ObjectOf(json);
    const auto incarnation = object ? NumberOf<std::uint64_t>(*object, "incarnation") : std::nullopt;
    const auto shift = object ? ShiftOf(*object) : std::nullopt;
    if (!incarnation || !shift)
    {
        return std::nullopt;
    }
    ClockReport report{*incarnation, *shift, {}};
    const auto peers = object->find("peers");
    if (peers != object->end() && peers->is_array())
    {
        for (const Json &one : *peers)
        {
            if (auto peer = PeerOf(one))
            {
                report.Peers.push_back(std::move(*peer));
            }
        }
    }
    return report;
}

std::optional<Mcap::Bytes> ShiftClockReport(Mcap::ByteView json, Moment later)
{
    auto object = ObjectOf(json);
    if (!object)
    {
        return std::nullopt;
    }
    Shift(*object, later);
    const auto peers = object->find("peers");
    if (peers != object->end() && peers->is_array())
    {
        for (Json &peer : *peers)
        {
            if (peer.is_object())
            {
                Shift(peer, later);
            }
        }
    }
    const std::string text = object->dump(-1, ' ', true, Json::error_handler_t::replace);
    return Mcap::Bytes(text.begin(), text.end());
}

}  // namespace Rabit::Merge
