#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "LedgerFile.h"
#include "gateway.idl.h"

namespace TestNode
{

struct PictureOptions
{
    std::string Node;
    std::string LedgerFile;
    std::uint64_t Life = 0;
    std::string To;  // empty: sends none
    std::uint64_t Count = 1;
    std::size_t Size = 60'000;  // octets
    std::int64_t PeriodNs = 0;  // from one to the next; 0: as the link takes them
};

// Sends large messages of the class bulk and takes those of others. For each it writes the lines of a note,
// with the names `picture_intent`, `picture_sent`, `picture_refused`, `picture_outcome` and `picture`.
class PictureClerk : public Rabit::RabitManager
{
public:
    explicit PictureClerk(const PictureOptions &options);

    // Adds the entries that pictures need to the configuration of a gateway.
    static void Configure(Rabit::GatewayConfig &config);

    void ExecuteUnitOfWork() override;

private:
    void LookWhetherThere();
    void Send();
    void FollowReceipts();
    void Take();

    const PictureOptions _options;
    TestNode::LedgerFile _ledger;
    std::shared_ptr<RabitQueue> _pictures;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    bool _isThere = false;
    std::uint64_t _sent = 0;    // accepted
    std::uint64_t _lastId = 0;  // of those given to the link, refused ones among them
    std::int64_t _next = 0;
    std::deque<std::pair<std::uint64_t, std::shared_ptr<Rabit::RabitQueueReceipt>>> _receipts;
};

}  // namespace TestNode
