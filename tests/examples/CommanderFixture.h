#pragma once

#include "Commander.h"

#include <rabit/ManualClock.h>
#include <rabit/QueueForwarder.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/gateway/GatewayManager.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CommanderTests
{
using namespace std::chrono_literals;

class FakeGateway : public Rabit::QueueForwarder
{
public:
    bool Accepts = true;
    std::vector<std::pair<std::string, Uav::Goto>> Sent;
    std::vector<std::pair<std::string, std::shared_ptr<Rabit::RabitMessage>>> All;
    std::vector<std::shared_ptr<Rabit::RabitQueueReceipt>> Receipts;

    bool Handles(const std::string &) const override { return true; }
    bool Forward(const std::string &queue, const std::shared_ptr<Rabit::RabitMessage> &message,
                 const std::shared_ptr<Rabit::RabitQueueReceipt> &receipt) override
    {
        if (!Accepts)
        {
            receipt->Begin();
            receipt->Refuse();
            return false;
        }
        All.emplace_back(queue, message);
        if (const auto *command = dynamic_cast<const Uav::Goto *>(message.get()))
            Sent.emplace_back(queue, *command);
        receipt->Begin();
        Receipts.push_back(receipt);
        return true;
    }
};

// A commander with the aircraft uav1 in its fleet.
class Commander : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<FakeGateway> _gateway = std::make_shared<FakeGateway>();
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    Rabit::RabitSteppedReactor _reactor{_workspace};
    Ground::Commander *_commander = nullptr;

    void SetUp() override
    {
        _workspace.SetQueueForwarder(_gateway);
        _workspace.AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        _workspace.AddPublishSubscribeMessage("uav1/Pose", _pose);
        SetState(Rabit::Gateway::NodeState::UP);
    }
    // Without a delay before the first command, unless the test says otherwise.
    void Start(Ground::Commander::Settings settings, std::chrono::milliseconds firstAfter = 0ms)
    {
        settings.FirstAfter = firstAfter;
        auto commander = std::make_unique<Ground::Commander>(std::move(settings), _workspace);
        _commander = commander.get();
        _reactor.AddManager(std::move(commander));
        _reactor.Start();
    }
    void SetState(Rabit::Gateway::NodeState state, std::uint64_t incarnation = 1)
    {
        Rabit::Gateway::NodeStatus status;
        status.node = "uav1";
        status.state = state;
        status.incarnation = incarnation;
        _fleet->nodes = {status};
        _fleet->PostMessage();
    }
    // Lets time pass; the aircraft goes on publishing its pose.
    void Run(std::chrono::milliseconds duration)
    {
        for (auto done = 0ms; done < duration; done += 100ms)
        {
            _pose->PostMessage();
            _reactor.RunFor(*_clock, 100ms);
        }
    }
    void Answer(std::uint32_t id, const std::string &node = "uav1")
    {
        auto ack = std::make_shared<Uav::CommandAck>();
        ack->id = id;
        ack->node = node;
        ack->stage = Uav::CommandStage::COMMAND_ACCEPTED;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", ack));
    }
};

}  // namespace CommanderTests
