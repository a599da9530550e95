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
    std::string To;  // empty: sends none
    std::uint64_t Count = 1;
    std::size_t Size = 60'000;  // octets
};

// Sends large messages of the class bulk, one after the other as its link takes them, and takes those of
// others. Of each it writes `picture_sent to= id=`, `picture_outcome to= id= is=` and `picture from= id=`.
class PictureClerk : public Rabit::RabitManager
{
public:
    explicit PictureClerk(const PictureOptions &options);

    // What a gateway needs so that pictures come and go.
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
    std::uint64_t _sent = 0;
    std::deque<std::pair<std::uint64_t, std::shared_ptr<Rabit::RabitQueueReceipt>>> _receipts;
};

}  // namespace TestNode
