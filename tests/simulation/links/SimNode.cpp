#include "SimNode.h"

#include <rabit/gateway/links/LinkFrameCodec.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace Rabit::Sim
{

namespace
{

// Types of the messages. All queues take the one of their own program; the others fail as their names say.
constexpr std::string_view GoodTypes[] = {"Good@0", "Good@1"};
// Part of the starts of a node with another program than before.
constexpr double OtherBuild = 0.1;
constexpr std::string_view WrongType = "Wrong";
constexpr std::string_view UnknownType = "Unknown";
constexpr std::string_view BrokenType = "Broken";

}  // namespace

SimNode::SimNode(SimWorld &world, std::size_t index)
    : _world(world), _index(index), _wallSeconds(world.Random.Between(1, 4'000'000))
{
}

std::size_t SimNode::NodeOf(std::string_view name) const
{
    return static_cast<std::size_t>(name.at(1) - '0');
}

std::size_t SimNode::QueueOf(std::string_view name) const
{
    return static_cast<std::size_t>(name.at(1) - '0');
}

void SimNode::Start(bool storageLost)
{
    if (storageLost)
    {
        _storedCounter = 0;
    }
    _clock = {.StartedAt = _world.Now,
              .Offset = LinkTime(_world.Random.Between(0, 1'000'000'000'000)),
              .DriftPpm = _world.Plan.Nodes[_index].DriftPpm};
    _world.Oracle.StartLife(_index);
    _world.Oracle.NewEpoch(_index);
    _world.LifeClocks.push_back(_clock);
    _queueLengths.assign(_world.Plan.Queues.size(), 0);
    _toldFull.assign(_world.Plan.Queues.size(), false);
    LinkSettings settings = _world.Plan.Settings;
    settings.Node = _world.Plan.Nodes[_index].Name;
    settings.Clock = _world.Random.Next() | 1;
    _build = (_build + (_wasStarted && _world.Random.Chance(OtherBuild) ? 1 : 0)) % std::size(GoodTypes);
    _wasStarted = true;
    _links = std::make_unique<LinkNode>(settings, *this, *this, *this);
}

void SimNode::Crash()
{
    _links.reset();
    _firstPreparation = _preparations.size();
    _world.Oracle.EndLife(_index);
    _world.Oracle.NewEpoch(_index);
}

// IncarnationStore, with the file and the clock of this machine.
std::uint64_t SimNode::Above(std::uint64_t floor)
{
    if (floor != 0)
    {
        _world.Oracle.NewEpoch(_index);
    }
    const IncarnationMode mode = _world.Plan.Nodes[_index].Incarnations;
    std::uint64_t counter = (floor >> 32) + 1;
    if (mode != IncarnationMode::WallClock)
    {
        counter = std::max(counter, _storedCounter + 1);
    }
    if (mode != IncarnationMode::Counter)
    {
        const std::int64_t seconds =
            std::max<std::int64_t>(_wallSeconds + _world.Now / std::chrono::seconds(1), 0);
        counter = std::max(counter, static_cast<std::uint64_t>(seconds));
    }
    _storedCounter = counter;
    return (counter << 32) | (_world.Random.Next() >> 32);
}

void SimNode::Enqueue(std::size_t link)
{
    const ScenarioLink &plan = _world.Plan.Links[link];
    const std::string &destination = _world.Plan.Nodes[plan.Destination].Name;
    const std::string &queue = _world.Plan.Queues[plan.Queue].Name;
    const double kind = _world.Random.Unit();
    const std::string_view type = kind < 0.97   ? GoodTypes[_build]
                                  : kind < 0.98 ? WrongType
                                  : kind < 0.99 ? UnknownType
                                                : BrokenType;
    const std::vector<std::uint8_t> payload = _world.Oracle.MakePayload(_world.Random);
    const LinkTime now = LocalNow();
    _links->Configure(destination, queue, plan.Options, now);
    const LinkEnqueued result = _links->Enqueue(destination, queue, type, LinkBytes::CopyOf(payload), now);
    _world.Oracle.OnEnqueue(link, type, payload, result.Refusal, result.Id, now);
}

bool SimNode::Forget(std::size_t node)
{
    const std::uint64_t before = _links->Counters().Forgotten;
    _links->Forget(_world.Plan.Nodes[node].Name);
    const bool forgotten = _links->Counters().Forgotten > before;
    if (forgotten)
    {
        _world.Oracle.Forgets(_index, node);
    }
    return forgotten;
}

bool SimNode::Receive(const Packet &packet)
{
    LinkFrame frame;
    if (!LinkFrameCodec::Decode(packet.Bytes, frame))
    {
        _world.Oracle.Fail(9, "a frame that a node sent cannot be decoded");
        return false;
    }
    frame.Source = _world.Plan.Nodes[packet.From].Name;
    return _links->OnFrame(frame, LocalNow());
}

void SimNode::ReceiveSpoiled(const Packet &packet)
{
    LinkFrame frame;
    LinkFrameCodec::Decode(packet.Bytes, frame);
    frame.Source = _world.Plan.Nodes[packet.From].Name;
    Spoil(frame, _world.Random);
    _links->OnFrame(frame, LocalNow());
}

bool SimNode::Consume(std::size_t queue)
{
    const ScenarioQueue &plan = _world.Plan.Queues[queue];
    std::size_t &length = _queueLengths[queue];
    if (length > 0)
    {
        --length;
        // Like a driver, reports room once after there was none.
        if (_toldFull[queue] && (_calm || !_world.Random.Chance(plan.PopEventLoss)))
        {
            _toldFull[queue] = false;
            _links->OnRoom(plan.Name);
        }
    }
    if (!_calm && length < plan.Capacity && _world.Random.Chance(plan.LocalFill))
    {
        ++length;
    }
    return length > 0;
}

void SimNode::Check()
{
    _links->VisitSenders(
        [this](std::string_view destination, std::string_view queue, const LinkSenderCounters &counters)
        { _world.Oracle.CheckSender(_index, destination, queue, counters); });
    std::size_t sessions = 0;
    _links->VisitReceivers([&](std::string_view, std::string_view, const LinkReceiverCounters &)
                           { ++sessions; });
    if (sessions > _world.Plan.Nodes.size() * _world.Plan.Queues.size())
    {
        _world.Oracle.Fail(6, "more sessions than links");
    }
}

void SimNode::Send(const LinkFrame &frame, std::string_view /*queue*/)
{
    Packet packet{
        .From = _index, .To = NodeOf(frame.Destination), .SenderLife = frame.SenderLife, .Bytes = {}};
    packet.Bytes.resize(LinkFrameCodec::EncodedSize(frame));
    LinkFrameCodec::Encode(frame, packet.Bytes);
    _world.Transmit(std::move(packet));
}

void SimNode::OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                        LinkOutcome outcome)
{
    _world.Oracle.OnOutcome(_index, id, destination, queue, outcome, LocalNow());
}

bool SimNode::Accepts(std::string_view /*source*/, std::string_view /*queue*/)
{
    return true;
}

// The oracle needs to see each refused message.
bool SimNode::AcceptsType(std::string_view /*queue*/, std::string_view /*type*/) const
{
    return true;
}

LocalQueueResult SimNode::Deliver(const LinkDelivery &delivery)
{
    Record *record =
        _world.Oracle.Find(_index, delivery.Source, delivery.Queue, delivery.Type, delivery.Payload);
    if (record == nullptr)
    {
        return LocalQueueResult::Full;
    }
    if (delivery.Type != GoodTypes[_build])
    {
        record->RefusedByQueue = true;
        return delivery.Type == UnknownType  ? LocalQueueResult::Unknown
               : delivery.Type == BrokenType ? LocalQueueResult::Undecodable
                                             : LocalQueueResult::WrongType;
    }
    if (delivery.Prepared)
    {
        const auto &prepared = *std::static_pointer_cast<std::vector<std::uint8_t>>(delivery.Prepared);
        if (!std::equal(prepared.begin(), prepared.end(), delivery.Payload.begin(), delivery.Payload.end()))
        {
            _world.Oracle.Fail(8, "one message was prepared and another one is delivered");
        }
    }
    else if (delivery.Payload.size() > _world.Plan.Settings.MaxDatagram)
    {
        _preparations.push_back({.Source = std::string(delivery.Source),
                                 .Queue = std::string(delivery.Queue),
                                 .SenderLife = delivery.SenderLife,
                                 .Number = delivery.Number,
                                 .Payload = {delivery.Payload.begin(), delivery.Payload.end()}});
        _world.Prepare(_index, _preparations.size() - 1);
        return LocalQueueResult::Later;
    }
    const std::size_t index = QueueOf(delivery.Queue);
    if (_queueLengths[index] >= _world.Plan.Queues[index].Capacity)
    {
        _toldFull[index] = true;
        return LocalQueueResult::Full;
    }
    if (++_queueLengths[index] == 1)
    {
        _world.QueueFilled(_index, index);
    }
    _world.Oracle.OnDelivered(*record, delivery.Redelivered, _world.LifeClocks[record->Life].At(_world.Now));
    return LocalQueueResult::Ok;
}

void SimNode::FinishPreparation(std::size_t index)
{
    if (!IsAlive() || index < _firstPreparation)
    {
        return;  // of a process that is gone
    }
    Preparation &done = _preparations[index];
    _links->Prepared(done.Source, done.Queue, done.SenderLife, done.Number,
                     std::make_shared<std::vector<std::uint8_t>>(std::move(done.Payload)), LocalNow());
}

std::size_t SimNode::Room(std::string_view queue) const
{
    const std::size_t index = QueueOf(queue);
    if (_world.Plan.Nodes[_index].RoomIsWrong && !_calm)
    {
        return static_cast<std::size_t>(_world.Random.Between(0, 300));
    }
    const std::size_t room = _world.Plan.Queues[index].Capacity - _queueLengths[index];
    _toldFull[index] = _toldFull[index] || room == 0;
    return room;
}

}  // namespace Rabit::Sim
