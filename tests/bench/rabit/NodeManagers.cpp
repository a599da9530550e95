#include "NodeManagers.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <iostream>

namespace Rabit::Bench
{
namespace
{

// An answer that has not come by then never will. While the two nodes look for each other they ask more
// often.
constexpr std::int64_t Patience = 1'000'000'000;
constexpr int PatienceAtFirstMSec = 50;
constexpr int WorkPeriodMSec = 500;
constexpr int QueueRoom = 1000;

// Four fifths of the default outbox of a link.
constexpr std::uint64_t MostMessagesUnderWay = 800;
constexpr std::uint64_t MostBytesUnderWay = 12u << 20;

}  // namespace

SampleManager::SampleManager(const std::string &name, const BenchOptions &options, const Names &names)
    : RabitManager(name), Options(options), _names(names)
{
    _out->padding.assign(options.Padding(), 0x5a);
    if (options.How == Carriage::Queue)
    {
        _queue = std::make_shared<RabitQueue>(QueueRoom, names.In);
        AddManagerMessageQueue(names.In, _queue);
        WakeUpManagerOnEnqueue(_queue);
    }
    else
    {
        AddPublishSubscribeMessage(names.Out, _out);
        AddPublishSubscribeMessage(names.In, _in);
        WakeUpManagerOnMessagePost(_in);
    }
    SetWakeupTimeDelayMSec(WorkPeriodMSec);
}

const Sample *SampleManager::Take()
{
    if (_queue)
    {
        return _queue->GetMessage(_taken) ? static_cast<const Sample *>(_taken.get()) : nullptr;
    }
    return _in->FetchMessage() && _in->WasPosted() ? _in.get() : nullptr;
}

bool SampleManager::Send(std::uint64_t number, std::int64_t sentAt,
                         std::shared_ptr<RabitQueueReceipt> receipt)
{
    _out->number = number;
    _out->sent_ns = sentAt;
    if (_queue)
    {
        return AddMessageToQueue(_names.Out, _out, std::move(receipt));
    }
    _out->PostMessage();
    return true;
}

void SampleManager::SendBack()
{
    if (_queue)
    {
        AddMessageToQueue(_names.Out, _taken);
        return;
    }
    _out->CopyMessage(_in.get());
    _out->PostMessage();
}

PingManager::PingManager(const BenchOptions &options, const Names &names)
    : SampleManager("PingManager", options, names), _score(options)
{
    SetWakeupTimeDelayMSec(PatienceAtFirstMSec);
}

void PingManager::ExecuteUnitOfWork()
{
    while (const Sample *answer = Take())
    {
        CountAnswer(*answer);
    }
    if (_score.IsComplete())
    {
        ShutdownAllManagers(true);
    }
    else if (_asked == 0)
    {
        Ask(0);
    }
    else if (Now() - _askedAt > Patience)
    {
        _score.Add(_asked, -1);
        Ask(_asked + 1);
    }
}

void PingManager::CountAnswer(const Sample &answer)
{
    const std::int64_t now = Now();
    if (answer.number != _asked || _score.IsComplete())
    {
        return;
    }
    _score.Add(answer.number, now - answer.sent_ns);
    if (_asked == 0)
    {
        SetWakeupTimeDelayMSec(WorkPeriodMSec);
    }
    if (!_score.IsComplete())
    {
        Ask(_asked + 1);
    }
}

void PingManager::Ask(std::uint64_t number)
{
    _asked = number;
    _askedAt = Now();
    Send(number, _askedAt);
}

PongManager::PongManager(const BenchOptions &options, const Names &names)
    : SampleManager("PongManager", options, names), _score(options)
{
}

void PongManager::ExecuteUnitOfWork()
{
    while (const Sample *sample = Take())
    {
        const std::uint64_t number = sample->number;
        SendBack();
        _score.Add(number);
    }
}

SourceManager::SourceManager(const BenchOptions &options, const Names &names)
    : SampleManager("SourceManager", options, names),
      _score(options),
      _mostUnderWay(std::clamp<std::uint64_t>(MostBytesUnderWay / options.Payload, 1, MostMessagesUnderWay)),
      _receiptEvery(std::clamp<std::uint64_t>(_mostUnderWay / 16, 1, 50))
{
    SetWakeupTimeDelayMSec(PatienceAtFirstMSec);
}

void SourceManager::ExecuteUnitOfWork()
{
    ForgetSettled();
    // The first message is refused as long as the other node is not known.
    while (_next <= Options.Last() && MaySend())
    {
        const bool withReceipt = _next % _receiptEvery == 0 || _next == Options.Last();
        const auto receipt = withReceipt ? std::make_shared<RabitQueueReceipt>() : nullptr;
        _score.Sending(_next);
        if (!Send(_next, Now(), receipt))
        {
            return;
        }
        if (receipt)
        {
            WakeUpManagerOnOutcome(receipt);
            _receipts.emplace_back(_next, receipt);
        }
        ++_next;
    }
    if (_next > Options.Last() && _receipts.empty() && !_complete)
    {
        _complete = true;
        _score.Complete();
        ShutdownAllManagers(true);
    }
}

// A link settles its messages in order, so a receipt for one stands for all before it.
void SourceManager::ForgetSettled()
{
    while (!_receipts.empty())
    {
        const auto &[number, receipt] = _receipts.front();
        const QueueOutcome outcome = receipt->Outcome();
        if (outcome == QueueOutcome::Pending)
        {
            return;
        }
        if (outcome != QueueOutcome::Delivered)
        {
            std::cout << "{\"failed\": \"" << ToString(outcome) << "\"}" << std::endl;
        }
        _settled = number + 1;
        _receipts.pop_front();
    }
}

bool SourceManager::MaySend() const
{
    return _next - _settled < _mostUnderWay;
}

PacedManager::PacedManager(const BenchOptions &options, const Names &names)
    : SampleManager("PacedManager", options, names), _score(options)
{
    AddPublishSubscribeMessage(FleetMessageName, _fleet);
    WakeUpManagerOnMessagePost(_fleet);
}

void PacedManager::ExecuteUnitOfWork()
{
    _fleet->FetchMessage();
    if (_begin == 0)
    {
        const bool met = std::any_of(_fleet->publications.begin(), _fleet->publications.end(),
                                     [](const auto &publication) { return publication.readers > 0; });
        if (!met && Options.Role != "announce")
        {
            return;
        }
        _begin = Now();
    }
    const auto due = static_cast<std::uint64_t>((Now() - _begin) / Options.Period);
    if (due > _sent && !_complete)
    {
        ++_sent;
        _score.Sending(_sent);
        Send(_sent, Now());
        if (_sent == Options.Last() && Options.Role != "announce")
        {
            _complete = true;
            _score.Complete();
            ShutdownAllManagers(true);
        }
    }
    const std::int64_t next = _begin + static_cast<std::int64_t>(_sent + 1) * Options.Period - Now();
    SetWakeupTimeDelaySec(std::max(static_cast<double>(next) * 1e-9, 1e-6));
}

SinkManager::SinkManager(const BenchOptions &options, const Names &names)
    : SampleManager("SinkManager", options, names), _score(options)
{
}

void SinkManager::ExecuteUnitOfWork()
{
    while (const Sample *sample = Take())
    {
        _score.Add(sample->number);
    }
}

JoinManager::JoinManager(const BenchOptions &options, const Names &names)
    : SampleManager("JoinManager", options, names)
{
}

void JoinManager::ExecuteUnitOfWork()
{
    if (Take() != nullptr)
    {
        std::cout << "{\"first_message_ns\": " << Now() - Options.SpawnedAt << "}" << std::endl;
        ShutdownAllManagers(true);
    }
}

}  // namespace Rabit::Bench
