// Receipts, requests, several timers, and queues of other types.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/QueueForwarder.h>
#include <rabit/QueueTypeException.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitQueueHandle.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitRequests.h>
#include <rabit/RabitRing.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitTimer.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [receipt]
class Sender : public Rabit::RabitManager
{
public:
    explicit Sender(Rabit::RabitWorkspace &workspace) : RabitManager("Sender", workspace) {}

    void ExecuteUnitOfWork() final
    {
        if (!_receipt)
        {
            _receipt = std::make_shared<Rabit::RabitQueueReceipt>();  // one for each message
            WakeUpManagerOnOutcome(_receipt);
            AddMessageToQueue("uav2/MissionControl", std::make_shared<Uav::GoHome>(), _receipt);
        }
        if (_receipt->Outcome() != Rabit::QueueOutcome::Pending)
        {
            Result = ToString(_receipt->Outcome());  // delivered, expired, in doubt or refused
        }
    }

    std::string Result;

private:
    std::shared_ptr<Rabit::RabitQueueReceipt> _receipt;
};
// [/receipt]

class Stepped : public ::testing::Test
{
protected:
    const std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    Rabit::RabitSteppedReactor _reactor{_workspace};
};

using QueuesExample = Stepped;

TEST_F(QueuesExample, AReceiptTellsThatAMessageWasRefused)
{
    auto sender = std::make_unique<Sender>(_workspace);
    const Sender &shown = *sender;
    _reactor.AddManager(std::move(sender));
    _reactor.Start();
    _reactor.RunDue();
    EXPECT_EQ(shown.Result, "refused");  // there is no gateway here that knows uav2
}

// [requests]
class Surveyor : public Rabit::RabitManager
{
public:
    explicit Surveyor(Rabit::RabitWorkspace &workspace) : RabitManager("Surveyor", workspace) {}

    void ExecuteUnitOfWork() final
    {
        if (!_asked)
        {
            auto request = std::make_shared<Uav::Goto>();
            request->id = _requests.NextId();
            request->reply_to = "ground/Surveyor";
            _asked = _requests.Send("Mission", request);
        }
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto reply = std::dynamic_pointer_cast<Uav::CommandAck>(message))
            {
                _requests.Take(reply->id, reply);
            }
        }
        for (const auto &ended : _requests.TakeEnded())
        {
            Ends.push_back(ToString(ended.End));  // answered, not delivered, no reply
        }
    }

    std::vector<std::string> Ends;

private:
    Rabit::RabitRequests<Uav::CommandAck> _requests{*this, 2s};
    bool _asked = false;
};
// [/requests]

TEST_F(QueuesExample, ARequestWithoutAReplyEnds)
{
    const auto queue =
        std::make_shared<Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>>(10, "Mission");
    _workspace.AddManagerMessageQueue("Mission", queue);
    auto surveyor = std::make_unique<Surveyor>(_workspace);
    const Surveyor &shown = *surveyor;
    _reactor.AddManager(std::move(surveyor));
    _reactor.Start();
    _reactor.RunFor(*_clock, 5s);
    EXPECT_EQ(queue->NoMessagesInQueue(), 1);
    EXPECT_EQ(shown.Ends, std::vector<std::string>{"no reply"});
}

// [timers]
class TwoRates : public Rabit::RabitManager
{
public:
    explicit TwoRates(Rabit::RabitWorkspace &workspace) : RabitManager("TwoRates", workspace) {}

    void ExecuteUnitOfWork() final
    {
        Reports += _report.IsDue(*this) ? 1 : 0;
        Looks += _look.IsDue(*this) ? 1 : 0;
        Rabit::RabitTimer::SleepUntilDue(*this, {&_report, &_look});
    }

    int Reports = 0;
    int Looks = 0;

private:
    Rabit::RabitTimer _report{1s};
    Rabit::RabitTimer _look{200ms};
};
// [/timers]

TEST_F(QueuesExample, PartsOfAUnitOfWorkRunAtTheirRates)
{
    auto manager = std::make_unique<TwoRates>(_workspace);
    const TwoRates &shown = *manager;
    _reactor.AddManager(std::move(manager));
    _reactor.Start();
    _reactor.RunFor(*_clock, 1900ms);
    EXPECT_EQ(shown.Reports, 2);
    EXPECT_EQ(shown.Looks, 10);
}

// [lines]
TEST_F(QueuesExample, AQueueMayHoldAnyType)
{
    const auto lines = std::make_shared<Rabit::RabitMessageQueue<std::string>>(100, "Lines");
    _workspace.AddManagerMessageQueue("Lines", lines);
    EXPECT_TRUE(_workspace.AddMessageToQueue("Lines", std::string("take off")));
    EXPECT_THROW(_workspace.AddMessageToQueue("Lines", 3), Rabit::QueueTypeException);

    const std::shared_ptr<Rabit::RabitQueueHandle> handle = _workspace.FindQueue("Lines");
    EXPECT_EQ(handle->FillLevel(), 1);
}
// [/lines]

// [forwarder]
// Takes messages for names that are no queues of this process: what a gateway does for `node/queue`.
class Mail : public Rabit::QueueForwarder
{
public:
    bool Handles(const std::string &queueName) const override { return queueName.starts_with("mail/"); }
    bool Forward(const std::string &queueName, const std::shared_ptr<Rabit::RabitMessage> & /*message*/,
                 const std::shared_ptr<Rabit::RabitQueueReceipt> &receipt) override
    {
        Sent.push_back(queueName);
        if (receipt)
        {
            receipt->Begin();
            receipt->Settle(Rabit::QueueOutcome::Delivered);
        }
        return true;
    }
    std::vector<std::string> Sent;
};
// [/forwarder]

TEST_F(QueuesExample, AForwarderTakesMessagesForQueuesElsewhere)
{
    const auto mail = std::make_shared<Mail>();
    _workspace.AddQueueForwarder("mail", mail);
    const auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
    EXPECT_TRUE(_workspace.AddMessageToQueue("mail/ground", std::make_shared<Uav::GoHome>(), receipt));
    EXPECT_EQ(receipt->Outcome(), Rabit::QueueOutcome::Delivered);
    EXPECT_EQ(mail->Sent, std::vector<std::string>{"mail/ground"});
}

// [ring]
TEST(RingExample, ARingRefusesWhenItIsFull)
{
    Rabit::RabitRing<int> ring(1);
    int first = 1;
    int second = 2;
    EXPECT_TRUE(ring.Push(first));
    EXPECT_FALSE(ring.Push(second));
    EXPECT_EQ(ring.Pop(), 1);
}
// [/ring]

}  // namespace
