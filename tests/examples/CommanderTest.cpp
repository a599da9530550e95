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

namespace
{
using namespace std::chrono_literals;
using Rabit::Gateway::NodeState;

class FakeGateway : public Rabit::QueueForwarder
{
public:
    bool Accepts = true;
    std::vector<std::pair<std::string, Uav::Goto>> Sent;

    bool Handles(const std::string &) const override { return true; }
    bool Forward(const std::string &queue, const std::shared_ptr<Rabit::RabitMessage> &message,
                 const std::shared_ptr<Rabit::RabitQueueReceipt> &) override
    {
        if (Accepts)
            Sent.emplace_back(queue, dynamic_cast<const Uav::Goto &>(*message));
        return Accepts;
    }
};

// A commander whose aircraft uav1 is there.
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
        SetState(NodeState::UP);
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
    void SetState(NodeState state)
    {
        Rabit::Gateway::NodeStatus status;
        status.node = "uav1";
        status.state = state;
        _fleet->nodes = {status};
        _fleet->PostMessage();
    }
    // Time goes by; the aircraft goes on publishing its pose.
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

TEST_F(Commander, SendsACommandEachPeriodToTheQueueOfTheAircraft)
{
    Start({.Node = "ground", .Period = 5s});
    Run(12s);
    ASSERT_EQ(_gateway->Sent.size(), 3u);
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        EXPECT_EQ(_gateway->Sent[i].first, "uav1/MissionControl");
        EXPECT_EQ(_gateway->Sent[i].second.id, i + 1);
        EXPECT_EQ(_gateway->Sent[i].second.reply_to, "ground/Commands");
    }
    EXPECT_EQ(_commander->Log().Of("uav1").Sent, 3u);
}

TEST_F(Commander, LetsAnAircraftFlyByItselfBeforeTheFirstCommand)
{
    Start({}, 2s);
    Run(1900ms);
    EXPECT_TRUE(_gateway->Sent.empty());
    Run(200ms);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
}

TEST_F(Commander, WaitsLessForTheFirstCommandInAShortRun)
{
    Start({.Duration = 4s}, 2s);
    Run(1s);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
}

TEST_F(Commander, SendsNothingToAnAircraftThatIsNotUp)
{
    SetState(NodeState::STALE);
    Start({});
    Run(2s);
    SetState(NodeState::LOST);
    Run(2s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, SendsNothingToANodeWithoutAPose)
{
    Start({});
    _reactor.RunFor(*_clock, 5s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, SendsNothingOnTheStrengthOfAnOldPose)
{
    _pose->PostMessage();
    _clock->Advance(2s);
    Start({});
    _reactor.RunFor(*_clock, 5s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, TriesARefusedCommandAgainWithTheSameNumber)
{
    _gateway->Accepts = false;
    Start({});
    Run(500ms);
    EXPECT_GT(_commander->Log().Of("uav1").Refused, 0u);
    _gateway->Accepts = true;
    Run(500ms);
    ASSERT_EQ(_gateway->Sent.size(), 1u);
    EXPECT_EQ(_gateway->Sent[0].second.id, 1u);
}

TEST_F(Commander, BooksAnswersAndPublishesTheTally)
{
    Start({});
    Run(1s);
    Answer(1);
    Run(100ms);
    Ground::CommandTally tally;
    ASSERT_TRUE(_workspace.FetchMessage("CommandTally", &tally));
    ASSERT_EQ(tally.nodes.size(), 1u);
    EXPECT_EQ(tally.nodes[0].node, "uav1");
    EXPECT_EQ(tally.nodes[0].sent, 1u);
    EXPECT_EQ(tally.nodes[0].acknowledged, 1u);
}

TEST_F(Commander, StopsSendingBeforeTheEndAndEndsOnTime)
{
    Start({.Period = 1s, .Duration = 10s, .Quiet = 3s});
    for (std::uint32_t id = 1; id <= 7; ++id)
    {
        Run(1s);
        Answer(id);
    }
    Run(2900ms);
    EXPECT_EQ(_gateway->Sent.size(), 7u);
    EXPECT_TRUE(_reactor.IsRunning());
    Run(200ms);
    EXPECT_FALSE(_reactor.IsRunning());
    EXPECT_TRUE(_commander->Log().Outstanding().empty());
}

TEST_F(Commander, WaitsAtTheEndForAnswersThatAreStillOut)
{
    Start({.Duration = 10s, .Quiet = 3s});
    Run(11s);
    EXPECT_TRUE(_reactor.IsRunning());
    Answer(1);
    Answer(2);
    Run(200ms);
    EXPECT_FALSE(_reactor.IsRunning());
}

TEST_F(Commander, DoesNotWaitForEver)
{
    Start({.Duration = 10s, .Quiet = 3s});
    Run(13s + 200ms);
    EXPECT_FALSE(_reactor.IsRunning());
    EXPECT_FALSE(_commander->Log().Outstanding().empty());
}

TEST_F(Commander, EndsWhenAskedToOnceTheAnswersAreThere)
{
    Start({.Period = 1s});
    Run(500ms);
    _commander->RequestEnd();
    Run(2s);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
    EXPECT_TRUE(_reactor.IsRunning());
    Answer(1);
    Run(100ms);
    EXPECT_FALSE(_reactor.IsRunning());
}

TEST_F(Commander, SendsForHalfOfAShortRun)
{
    Start({.Period = 500ms, .Duration = 2s, .Quiet = 3s});
    Run(2s);
    EXPECT_EQ(_gateway->Sent.size(), 2u);
}

}  // namespace
