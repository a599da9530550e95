#pragma once

#include "ground.idl.h"
#include "uav.idl.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace Ground
{

// A page asks what the server's clock says, and tells what its own said.
struct ClockRequest
{
    double PageS = 0;
};

// What a page asks for. A text that is anything but one of the three, with exactly its fields, each of its
// type and within its range, is refused.
//
//   {"type": "clock", "page_s": 1.5}
//   {"type": "order", "ref": 1, "kind": "goto", "node": "uav1", "latitude_deg": 47.4, "longitude_deg": 8.5,
//    "altitude_m": 510, "speed_mps": 12}                      home and search have neither of the last four
//   {"type": "area", "ref": 2, "latitude_deg": 47.4, "longitude_deg": 8.5, "north_m": 400, "east_m": 600,
//    "altitude_m": 510, "speed_mps": 16, "lane_m": 60}
struct PageRequest
{
    std::variant<std::monostate, ClockRequest, Order, Uav::SearchArea> Wish;
    std::optional<std::int64_t> Ref;  // the page's number for it, if that could be read
    std::string Refusal;              // why there is no wish; empty if there is one
};

PageRequest ParsePageRequest(const std::string &text);

// The answers, as JSON.
std::string ClockReply(const ClockRequest &request, double serverS);
std::string AcceptedReply(std::int64_t ref);
std::string RefusedReply(std::optional<std::int64_t> ref, const std::string &reason);

// Whether it is a name that a node may have.
bool IsNodeName(const std::string &name);

}  // namespace Ground
