#include "PictureClerk.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>

#include "Padding.h"
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
    while (_isThere && _sent < _options.Count && Now() >= _next)
    {
        auto picture = std::make_shared<Ledger::Note>();
        picture->from = _options.Node;
        picture->life = _options.Life;
        picture->id = ++_lastId;
        picture->padding = Padding(_lastId, _options.Size);
        const auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
        const std::string rest = " to=" + _options.To + " id=" + std::to_string(_lastId);
        _ledger.Line("picture_intent" + rest + " expire_s=0 octets=" + std::to_string(_options.Size));
        if (!AddMessageToQueue(_options.To + '/' + PicturesQueue, picture, receipt))
        {
            _ledger.Line("picture_refused" + rest);
            return;  // tried again in the next unit of work
        }
        ++_sent;
        _next = Now() + _options.PeriodNs;
        _ledger.Line("picture_sent" + rest);
        _receipts.emplace_back(_lastId, receipt);
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
        const auto *picture = dynamic_cast<const Ledger::Note *>(message.get());
        if (picture != nullptr && IsPadding(picture->padding, picture->id))
            _ledger.Line("picture from=" + picture->from + " life=" + std::to_string(picture->life) + " id=" +
                         std::to_string(picture->id) + " octets=" + std::to_string(picture->padding.size()) +
                         (picture->IsRedelivered() ? " redelivered=1" : ""));
        else
            _ledger.Line("garbled");
    }
}

}  // namespace TestNode
