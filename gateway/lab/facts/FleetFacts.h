#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit::Facts
{

// The changes from one `Gateway/Fleet` of a node to its next. The message comes once a second and tells of
// all nodes, so a whole fleet's would be too many to look at one by one.
class FleetFacts
{
public:
    using Json = nlohmann::ordered_json;

    // Returns one object for each change, without a time:
    //   {"fact": "self", "incarnation": TEXT}                  once
    //   {"fact": "peer", "of": NODE, "state": "UP", "reason": TEXT, "incarnation": TEXT}
    //   {"fact": "problem", "subject": TEXT, "node": NODE, "reason": TEXT}, and the same with "solved"
    //   {"fact": "air", "used": B/s, "budget": B/s, "capacity": B/s}     with each message
    //   {"fact": "publication", "message": NAME, "offered": COUNT, "replaced": COUNT}    since the beginning
    // Nothing if the bytes are no such message.
    std::vector<Json> Look(std::span<const std::uint8_t> sample);
    std::vector<Json> Look(const Gateway::Fleet &fleet);

private:
    struct Peer
    {
        Gateway::NodeState State;
        std::uint64_t Incarnation;
    };
    using Problem = std::tuple<std::string, std::string, std::string>;

    std::optional<std::uint64_t> _incarnation;
    std::map<std::string, Peer> _peers;
    std::vector<Problem> _problems;  // in order
    // By published message, what was told last: posts, and those that a newer one replaced.
    std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> _publications;
};

}  // namespace Rabit::Facts
