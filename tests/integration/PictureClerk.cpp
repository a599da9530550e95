#include "PictureClerk.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>

#include "ledger.idl.h"

namespace TestNode
{
namespace
{
constexpr const char *PicturesQueue = "Pictures";
constexpr int WorkPeriodMSec = 20;
constexpr int QueueRoom = 100;
}  // namespace

PictureClerk::PictureClerk(const PictureOptions &options)
    : RabitManager("PictureClerk"),
      _options(options),
      _ledger(options.LedgerFile),
      _pictures(std::make_shared<RabitQueue>(QueueRoom, PicturesQueue))
{
    AddManagerMessageQueue(PicturesQueue, _pictures);
    WakeUpManagerOnEnqueue(_pictures);
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    SetWakeupTimeDelayMSec(WorkPeriodMSec);
}

void PictureClerk::Configure(Rabit::GatewayConfig &config)
{
    config.Accept.push_back({PicturesQueue, {"Ledger::Note"}});
    Rabit::SendRule rule;
    rule.Queue = PicturesQueue;
    rule.Class = Rabit::TrafficClass::Bulk;
    config.Send.insert(config.Send.begin(), rule);
}

void PictureClerk::ExecuteUnitOfWork()
{
    LookWhetherThere();
    Send();
    FollowReceipts();
    Take();
}

void PictureClerk::LookWhetherThere()
{
    if (_isThere || !_fleet->FetchMessage())
        return;
    _isThere = std::any_of(_fleet->nodes.begin(), _fleet->nodes.end(),
                           [this](const auto &node) {
                               return node.node == _options.To && node.state == Rabit::Gateway::NodeState::UP;
                           });
}

void PictureClerk::Send()
{
    while (_isThere && _sent < _options.Count)
    {
        auto picture = std::make_shared<Ledger::Note>();
        picture->from = _options.Node;
        picture->id = _sent + 1;
        picture->padding.assign(_options.Size, 0x5a);
        const auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
        if (!AddMessageToQueue(_options.To + '/' + PicturesQueue, picture, receipt))
            return;  // tried again in the next unit of work
        ++_sent;
        _ledger.Line("picture_sent to=" + _options.To + " id=" + std::to_string(_sent));
        _receipts.emplace_back(_sent, receipt);
    }
}

void PictureClerk::FollowReceipts()
{
    while (!_receipts.empty() && _receipts.front().second->Outcome() != Rabit::QueueOutcome::Pending)
    {
        const auto &[id, receipt] = _receipts.front();
        _ledger.Line("picture_outcome to=" + _options.To + " id=" + std::to_string(id) + " is=\"" +
                     Rabit::ToString(receipt->Outcome()) + '"');
        _receipts.pop_front();
    }
}

void PictureClerk::Take()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (_pictures->GetMessage(message))
    {
        if (const auto *picture = dynamic_cast<const Ledger::Note *>(message.get()))
            _ledger.Line("picture from=" + picture->from + " id=" + std::to_string(picture->id));
        else
            _ledger.Line("garbled");
    }
}

}  // namespace TestNode
