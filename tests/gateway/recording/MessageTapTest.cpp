#include "recording/MessageTap.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "../../core/TestMessages.h"
#include "FakeDisk.h"

namespace Rabit
{
namespace
{

// The node begins to record while its managers post: each tap begins somewhere among the posts of another
// thread, and posts go on until it has begun.
TEST(MessageTap, RecordsEachPostFromItsBeginningOn)
{
    RecordingSettings settings;
    settings.Name = "uav1";
    settings.Record.Folder = "/recordings";
    const auto clock = RabitClock::System();
    const auto target =
        std::make_shared<RecordingTarget>("uav1", *clock, std::make_unique<FakeDisk>(), settings);
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
        tap->CountMissed();
        tap->CountMissed();
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

}  // namespace
}  // namespace Rabit
