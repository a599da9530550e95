#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// What each node of a fleet puts on the air by its configuration, in bytes of IP packets as gateway/RADIO.md
// reckons them: all that goes while nobody comes, goes or loses anything.
namespace Rabit::Tool
{

// What a person says of messages and queues: `uav1/Pose` (of that node; `*` and `?` stand for any), `Pose`
// (of all). The first that fits holds.
class Stated
{
public:
    void Add(const std::string &what, double number);
    // Of a message that this node posts, or a queue that it sends to.
    std::optional<double> Of(const std::string &node, const std::string &name) const;

private:
    std::vector<std::pair<std::string, double>> _stated;
};

struct AirPlanInput
{
    Stated Rates;  // posts a second; of a queue: messages a second to each node that accepts it
    Stated Sizes;  // bytes of CDR; also by the name of a type
    // Bytes of all samples of a type; nothing if they differ or nobody knows.
    std::function<std::optional<std::size_t>(const std::string &type)> SizeOfType;
};

// One of the things that a node sends.
struct AirItem
{
    std::string What;              // `beats`, `discovery`, `Pose`, `MissionControl of uav2`
    double Bytes = 0.0;            // one of it, to one destination; without a size known its headers alone
    std::optional<double> Rate{};  // a second
    std::size_t Copies = 1;        // destinations that have one each
    bool SizeKnown = true;

    double BytesPerSecond() const { return Rate.value_or(0.0) * Bytes * static_cast<double>(Copies); }
};

struct AirPlan
{
    const GatewayConfig *Config = nullptr;
    std::vector<AirItem> Items;

    // As far as it is known.
    double BytesPerSecond() const;
    // `rate of Findings`, `size of Findings`.
    std::vector<std::string> NotKnown() const;
};

// In the fleet's order, which must outlive them. A node that is alone is taken to have one reader for each
// message.
std::vector<AirPlan> AirPlansOf(const std::vector<GatewayConfig> &fleet, const AirPlanInput &input);

// What exceeds the node's budget, in words with what takes most; empty if it fits, or there is no budget.
std::string WhyAboveBudget(const AirPlan &plan);

// Names the messages that take more than a second of the budget each time; empty if none is known to.
std::vector<std::string> LargerThanASecond(const AirPlan &plan);

}  // namespace Rabit::Tool
