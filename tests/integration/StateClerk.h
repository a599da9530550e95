#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "LedgerFile.h"
#include "Orders.h"
#include "gateway.idl.h"
#include "ledger.idl.h"

namespace TestNode
{

struct StateOptions
{
    std::string LedgerFile;
    std::size_t Count = 0;      // of States that each node publishes, the same on all nodes; 0: none
    std::uint64_t Posts = 0;    // of each; 0: the node only follows those of the others
    std::int64_t PeriodNs = 0;  // from one to the next
    std::size_t Size = 0;       // octets of padding in each
};

// Publishes States, which it posts in turn for a while and then leaves unchanged, and follows those of the
// other nodes. For each it writes `state_posted message= number=`, `state from= message= number= age_s=`,
// and on a change `state_samples message= written=`.
class StateClerk : public Rabit::RabitManager
{
public:
    // `orders`: for more posts than the options say.
    StateClerk(const StateOptions &options, const Orders &orders);

    // Adds the entries that the States need to the configuration of a gateway.
    static void Configure(const StateOptions &options, Rabit::GatewayConfig &config);

    void ExecuteUnitOfWork() override;

private:
    void FollowFleet();
    void Post();
    void FollowStates();

    const StateOptions _options;
    const Orders &_orders;
    TestNode::LedgerFile _ledger;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::vector<std::shared_ptr<Ledger::Tick>> _own;
    std::map<std::pair<std::string, std::size_t>, std::shared_ptr<Ledger::Tick>> _others;
    std::map<std::string, std::uint64_t> _written;
    std::uint64_t _posts = 0;  // of all of them
    std::int64_t _nextPost = 0;
};

}  // namespace TestNode
