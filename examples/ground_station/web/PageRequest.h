#pragma once

#include "ground.idl.h"
#include "uav.idl.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace Ground
{

// A page requests the time of the server's clock, and sends that of its own.
struct ClockRequest
{
    double PageS = 0;
};

// A request of a page. The text must be one of these three, with exactly its fields, each of the right type
// and in range; otherwise it is refused.
//
//   {"type": "clock", "page_s": 1.5}
//   {"type": "order", "ref": 1, "kind": "goto", "node": "uav1", "latitude_deg": 47.4, "longitude_deg": 8.5,
//    "altitude_m": 510, "speed_mps": 12}                      home and search have neither of the last four
//   {"type": "area", "ref": 2, "latitude_deg": 47.4, "longitude_deg": 8.5, "north_m": 400, "east_m": 600,
//    "altitude_m": 510, "speed_mps": 16, "lane_m": 60}
struct PageRequest
{
    std::variant<std::monostate, ClockRequest, Order, Uav::SearchArea> Wish;
    std::optional<std::int64_t> Ref;  // the page's number for the request, if that could be read
    std::string Refusal;              // why the request was refused; empty if it was not
};

PageRequest ParsePageRequest(const std::string &text);

// The answers, as JSON.
std::string ClockReply(const ClockRequest &request, double serverS);
std::string AcceptedReply(std::int64_t ref);
std::string RefusedReply(std::optional<std::int64_t> ref, const std::string &reason);

// True if a node may have that name.
bool IsNodeName(const std::string &name);

}  // namespace Ground
