#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// The bytes of IP packets that each node of a fleet sends by its configuration, by the rules of
// docs/how_to/radio.md. The rules assume that no node comes or goes, and that nothing is lost.
namespace Rabit::Tool
{

// Rates or sizes that a person states for messages and queues: `uav1/Pose` (of that node; `*` and `?` are
// wildcards), `Pose` (of all nodes), `Px4/Command` (of all nodes that call a message so). The first match
// holds.
class Stated
{
public:
    void Add(const std::string &what, double number);
    // Returns the number for a message that this node posts, or a queue that it sends to.
    std::optional<double> Of(const std::string &node, const std::string &name) const;

private:
    std::vector<std::pair<std::string, double>> _stated;
};

struct AirPlanInput
{
    Stated Rates;  // posts a second; of a queue: messages a second to each node that accepts it
    Stated Sizes;  // bytes of CDR; also by the name of a type
    // Size in bytes of every sample of a type; empty if sizes differ or the type is unknown.
    std::function<std::optional<std::size_t>(const std::string &type)> SizeOfType;
};

// One kind of traffic that a node sends.
struct AirItem
{
    std::string What;              // `beats`, `discovery`, `Pose`, `MissionControl of uav2`
    double Bytes = 0.0;            // one of it, to one destination; without a size known its headers alone
    std::optional<double> Rate{};  // a second
    std::size_t Copies = 1;        // destinations that have one each
    bool SizeKnown = true;
    std::string Name{};  // by which its rate and size are stated; empty: What

    double BytesPerSecond() const { return Rate.value_or(0.0) * Bytes * static_cast<double>(Copies); }
};

struct AirPlan
{
    const GatewayConfig *Config = nullptr;
    std::vector<AirItem> Items;

    // Of several paths of a node, the one that is planned; empty: the node has no paths.
    std::string Path() const { return Config->Paths.empty() ? "" : Config->Paths.front().Name; }

    // The sum over the items whose rate is known. An item of unknown size counts its headers alone.
    double BytesPerSecond() const;
    // Lists missing numbers, as `rate of Findings`, `size of Findings`.
    std::vector<std::string> NotKnown() const;
};

// Returns the names, of the messages and queues of `fleet`, for which a person may state a rate. `types`:
// adds the names of their types, for sizes.
std::vector<std::string> NamesIn(const std::vector<GatewayConfig> &fleet, bool types);

// True if a stated name, such as `uav1/Pose`, fits one of `names`.
bool IsAmong(const std::vector<std::string> &names, const std::string &stated);

// Returns the nodes, with an entry for each path of a node that has some, the best path first.
std::vector<GatewayConfig> EachPathOf(const std::vector<GatewayConfig> &fleet);

// Returns a plan for each entry of `fleet`, in its order; `fleet` must outlive them. Entries with one name
// are the paths of one node, each of which is planned as if it carried all. If a node is alone in its domain,
// one reader is assumed for each of its messages.
std::vector<AirPlan> AirPlansOf(const std::vector<GatewayConfig> &fleet, const AirPlanInput &input);

// Says by how much the node exceeds its budget, and names the largest item; empty if it fits, or has no
// budget.
std::string WhyAboveBudget(const AirPlan &plan);

// Names the messages of which a single one takes more than a second of the budget; empty if there is none.
std::vector<std::string> LargerThanASecond(const AirPlan &plan);

}  // namespace Rabit::Tool
