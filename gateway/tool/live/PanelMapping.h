#pragma once

#include <rabit/gateway/PanelRule.h>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "live/LiveProtocol.h"

namespace Rabit::Tool
{

// Converts values of messages to the schemas of viewers' panels, in JSON. Pure.
class PanelMapping
{
public:
    explicit PanelMapping(PanelRule rule) : _rule(std::move(rule)) {}

    const std::string &Message() const { return _rule.Message; }
    // Returns the channel for that message of a node.
    LiveProtocol::Channel ChannelFor(const std::string &node) const;
    // Converts a value, in the JSON of idl/dynamic; `postedAt` is UTC in nanoseconds since 1970. Empty if a
    // field is missing, or is no number where one is required.
    std::optional<std::string> Show(const std::string &node, const std::string &value,
                                    std::uint64_t postedAt) const;
    // Says in one line why a value of that message cannot be shown.
    std::string WhyNot(const std::string &value) const;

private:
    PanelRule _rule;
};

// A line for the log of a viewer; level: 1 (debug) to 5 (fatal).
namespace PanelLog
{
LiveProtocol::Channel Channel();
std::string Line(std::uint64_t time, int level, const std::string &name, const std::string &message);
}  // namespace PanelLog

}  // namespace Rabit::Tool
