#include "recording/MessageTap.h"

#include <rabit/ManagerStatusMessage.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "../../core/TestMessages.h"
#include "FakeDisk.h"
#include "recording/MessageTaps.h"

namespace Rabit
{
namespace
{

std::shared_ptr<RecordingTarget> MakeTarget(const RabitClock &clock)
{
    RecordingSettings settings;
    settings.Name = "uav1";
    settings.Record.Folder = "/recordings";
    return std::make_shared<RecordingTarget>("uav1", clock, std::make_unique<FakeDisk>(), settings);
}

// Posts a message on a thread of its own. Holds that thread between the post and all handlers that are
// connected later, as a machine may.
class HeldPost
{
public:
    HeldPost(PublishSubscribeMessage &global, RabitMessage &message)
        : _connection(global.ConnectSomethingPublished(RabitQuickHandler(
              [this]
              {
                  if (!_wasHeld.exchange(true))
                  {
                      _isPosted.set_value();
                      _isReleased.get_future().wait();
                  }
              }))),
          _thread(
              [this, &global, &message]
              {
                  _mayPost.get_future().wait();
                  global.PostMessage(&message);
              })
    {
    }
    void Post()
    {
        _mayPost.set_value();
        _isPosted.get_future().wait();
    }
    void Release()
    {
        _isReleased.set_value();
        _thread.join();
    }

private:
    std::atomic<bool> _wasHeld = false;
    std::promise<void> _mayPost;
    std::promise<void> _isPosted;
    std::promise<void> _isReleased;
    RabitScopedConnection _connection;
    std::thread _thread;
};

// The node begins to record while its managers post: each tap begins somewhere among the posts of another
// thread, and posts go on until it has begun.
TEST(MessageTap, RecordsEachPostFromItsBeginningOn)
{
    const auto clock = RabitClock::System();
    const auto target = MakeTarget(*clock);
    for (int round = 0; round < 300; ++round)
    {
        const auto global =
            std::make_shared<PublishSubscribeMessage>(std::make_unique<RabitTest::NumberMessage>(), clock);
        std::vector<int> numbers;
        const auto tap = std::make_shared<MessageTap>(
            global, target, target->Inbox().AddStream({.Topic = std::to_string(round), .SchemaName = ""}),
            [&numbers](const RabitMessage &message, Mcap::Bytes &)
            {
                numbers.push_back(dynamic_cast<const RabitTest::NumberMessage &>(message).Number);
                return true;
            });
        std::atomic<bool> posts = false;
        std::atomic<bool> hasBegun = false;
        int last = 0;
        std::thread poster(
            [&]
            {
                RabitTest::NumberMessage message;
                while (!hasBegun || last < 3)
                {
                    message.Number = ++last;
                    global->PostMessage(&message);
                    posts = true;
                }
            });
        while (!posts)
        {
            std::this_thread::yield();
        }
        tap->Begin();
        hasBegun = true;
        poster.join();
        ASSERT_FALSE(numbers.empty());
        for (std::size_t at = 0; at < numbers.size(); ++at)
        {
            ASSERT_EQ(numbers[at], numbers.front() + static_cast<int>(at)) << "round " << round;
        }
        ASSERT_EQ(numbers.back(), last) << "round " << round;
    }
    target->End();
    EXPECT_TRUE(target->Status().Lost.empty());
}

TEST(MessageTap, CountsNoPostAsLostWhoseThreadIsLate)
{
    RabitWorkspace workspace;
    const auto status = std::make_shared<ManagerStatusMessage>();
    workspace.AddPublishSubscribeMessage("Pilot:ManagerStatusMessage", status);
    GatewayConfig config;
    config.Node = "uav1";
    config.Record.emplace();
    const auto target = MakeTarget(workspace.GetClock());
    MessageTaps taps(config, workspace, target);
    HeldPost held(*workspace.FindGlobalMessage("Pilot:ManagerStatusMessage"), *status);
    taps.Look();
    held.Post();
    for (int look = 0; look < 3; ++look)
    {
        taps.Look();
    }
    held.Release();
    taps.Look();
    target->End();
    EXPECT_TRUE(target->Status().Lost.empty());
}

TEST(MessageTap, CountsAPostAsLostThatAnotherThreadReplacedBeforeItWasRecorded)
{
    const auto clock = RabitClock::System();
    const auto target = MakeTarget(*clock);
    const auto global =
        std::make_shared<PublishSubscribeMessage>(std::make_unique<RabitTest::NumberMessage>(), clock);
    std::vector<int> numbers;
    const auto tap = std::make_shared<MessageTap>(
        global, target, target->Inbox().AddStream({.Topic = "uav1/Number", .SchemaName = ""}),
        [&numbers](const RabitMessage &message, Mcap::Bytes &)
        {
            numbers.push_back(dynamic_cast<const RabitTest::NumberMessage &>(message).Number);
            return true;
        });
    RabitTest::NumberMessage first;
    first.Number = 1;
    HeldPost held(*global, first);
    tap->Begin();
    held.Post();
    RabitTest::NumberMessage second;
    second.Number = 2;
    global->PostMessage(&second);
    held.Release();
    target->End();
    EXPECT_EQ(numbers, std::vector<int>{2});
    EXPECT_EQ(target->Status().Lost, (std::map<std::string, std::uint64_t>{{"uav1/Number", 1}}));
}

}  // namespace
}  // namespace Rabit
