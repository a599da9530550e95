#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitNonBlockingSPSCQueue.h>
#include <rabit/SafeQueue.h>

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace
{

using namespace Rabit;

// The promises of both kinds of queue.
template <typename Queue>
class AnyQueue : public testing::Test
{
};
using QueueKinds = testing::Types<RabitMessageQueue<int>, RabitNonBlockingSPSCQueue<int>>;
TYPED_TEST_SUITE(AnyQueue, QueueKinds);

TYPED_TEST(AnyQueue, GivesMessagesBackInTheOrderInWhichTheyWereAdded)
{
    TypeParam queue(100, "Queue");
    // Goes several times around the ring buffer.
    int next = 0;
    for (int added = 0; added < 500;)
    {
        for (int i = 0; i < 70; ++i)
        {
            ASSERT_TRUE(queue.AddMessage(added++));
        }
        int message = -1;
        while (queue.GetMessage(message))
        {
            ASSERT_EQ(message, next++);
        }
    }
    EXPECT_EQ(next, 560);
}

TYPED_TEST(AnyQueue, HoldsExactlyItsCapacityAndRefusesMore)
{
    TypeParam queue(3, "Queue");
    EXPECT_TRUE(queue.AddMessage(1));
    EXPECT_TRUE(queue.AddMessage(2));
    EXPECT_TRUE(queue.AddMessage(3));
    EXPECT_FALSE(queue.AddMessage(4));
    EXPECT_FALSE(queue.AddMessageNoEventTrigger(4));
}

TYPED_TEST(AnyQueue, TellsHowFullItIsAndHowManyMessagesItRefused)
{
    TypeParam queue(2, "Queue");
    EXPECT_EQ(queue.NoMessagesInQueue(), 0);
    EXPECT_TRUE(queue.IsEmpty());
    queue.AddMessage(1);
    queue.AddMessageNoEventTrigger(2);
    EXPECT_EQ(queue.NoMessagesInQueue(), 2);
    EXPECT_EQ(queue.GetNumberOfRefusedMessages(), 0U);
    queue.AddMessage(3);
    queue.AddMessageNoEventTrigger(4);
    EXPECT_EQ(queue.NoMessagesInQueue(), 2);
    EXPECT_EQ(queue.GetNumberOfRefusedMessages(), 2U);
    int message = 0;
    queue.GetMessage(message);
    EXPECT_EQ(queue.NoMessagesInQueue(), 1);
    queue.ClearMessageQueue();
    EXPECT_FALSE(queue.GetMessage(message));
    EXPECT_EQ(queue.NoMessagesInQueue(), 0);
    EXPECT_EQ(queue.GetNumberOfRefusedMessages(), 2U);
}

TYPED_TEST(AnyQueue, ClampsItsCapacityAndNamesItself)
{
    TypeParam small(-5, "");
    EXPECT_EQ(small.GetMaxNoMessagesAllowedInQueue(), 1);
    EXPECT_EQ(small.GetMessageQueueName(), "MessageQueue");
    TypeParam large(1000001, "Large");
    EXPECT_EQ(large.GetMaxNoMessagesAllowedInQueue(), 1000000);
    EXPECT_EQ(large.GetMessageQueueName(), "Large");
}

TYPED_TEST(AnyQueue, LeavesTheTargetAloneWhenEmpty)
{
    TypeParam queue(3, "Queue");
    int message = 42;
    EXPECT_FALSE(queue.GetMessage(message));
    EXPECT_EQ(message, 42);
}

TYPED_TEST(AnyQueue, TellsOfEachMessageThatWasAddedOrTakenAndOfNoOther)
{
    TypeParam queue(2, "Queue");
    int enqueued = 0;
    int dequeued = 0;
    queue.Register_SomethingEnqueued([&] { ++enqueued; });
    queue.Register_SomethingDequeued([&] { ++dequeued; });
    queue.AddMessage(1);
    queue.AddMessageNoEventTrigger(2);
    queue.AddMessage(3);  // full
    EXPECT_EQ(enqueued, 1);
    int message = 0;
    queue.GetMessage(message);
    queue.GetMessage(message);
    queue.GetMessage(message);  // empty
    EXPECT_EQ(dequeued, 2);
}

TYPED_TEST(AnyQueue, HandlersMayUseTheQueue)
{
    TypeParam queue(10, "Queue");
    std::vector<int> taken;
    queue.Register_SomethingEnqueued(
        [&]
        {
            int message = 0;
            while (queue.GetMessage(message))
            {
                taken.push_back(message);
            }
        });
    queue.AddMessage(5);
    EXPECT_EQ(taken, std::vector<int>{5});
}

TYPED_TEST(AnyQueue, IsEmptyAfterClearing)
{
    TypeParam queue(10, "Queue");
    queue.AddMessage(1);
    queue.AddMessage(2);
    queue.ClearMessageQueue();
    int message = 0;
    EXPECT_FALSE(queue.GetMessage(message));
    EXPECT_TRUE(queue.AddMessage(3));
    EXPECT_TRUE(queue.GetMessage(message));
    EXPECT_EQ(message, 3);
}

TYPED_TEST(AnyQueue, CarriesEverythingFromOneThreadToAnotherInOrder)
{
    constexpr int count = 20000;
    TypeParam queue(64, "Queue");
    std::thread producer(
        [&]
        {
            for (int i = 0; i < count;)
            {
                if (queue.AddMessage(i))
                {
                    ++i;
                }
                else
                {
                    std::this_thread::yield();
                }
            }
        });
    for (int expected = 0; expected < count;)
    {
        int message = -1;
        if (queue.GetMessage(message))
        {
            ASSERT_EQ(message, expected++);
        }
        else
        {
            std::this_thread::yield();
        }
    }
    producer.join();
}

// Elements whose destructor calls back would deadlock under the queue's lock.
struct Recursive
{
    RabitMessageQueue<std::shared_ptr<Recursive>> *Queue = nullptr;
    int *Destroyed = nullptr;
    ~Recursive()
    {
        Queue->IsEmpty();
        ++*Destroyed;
    }
};

TEST(RabitMessageQueue, DestroysItsMessagesOutsideItsLock)
{
    int destroyed = 0;
    {
        RabitMessageQueue<std::shared_ptr<Recursive>> queue(10, "Queue");
        const auto make = [&]
        {
            auto message = std::make_shared<Recursive>();
            message->Queue = &queue;
            message->Destroyed = &destroyed;
            return message;
        };
        queue.AddMessage(make());
        queue.AddMessage(make());
        std::shared_ptr<Recursive> target = make();
        queue.GetMessage(target);
        queue.ClearMessageQueue();
        target.reset();
    }
    EXPECT_EQ(destroyed, 3);
}

TEST(RabitMessageQueue, CountsItsMessages)
{
    RabitMessageQueue<int> queue(10, "Queue");
    EXPECT_TRUE(queue.IsEmpty());
    queue.AddMessage(1);
    queue.AddMessage(2);
    EXPECT_EQ(queue.NoMessagesInQueue(), 2);
    EXPECT_FALSE(queue.IsEmpty());
}

TEST(RabitMessageQueue, TakesElementsThatCanOnlyBeMoved)
{
    RabitMessageQueue<std::unique_ptr<int>> queue(100, "Queue");
    for (int i = 0; i < 40; ++i)
    {
        queue.AddMessage(std::make_unique<int>(i));
    }
    std::unique_ptr<int> message;
    ASSERT_TRUE(queue.GetMessage(message));
    EXPECT_EQ(*message, 0);
}

TEST(RabitMessageQueue, LosesNothingWithManyProducersAndConsumers)
{
    constexpr int perProducer = 10000;
    constexpr int producers = 4;
    RabitMessageQueue<int> queue(128, "Queue");
    std::vector<std::thread> threads;
    for (int p = 0; p < producers; ++p)
    {
        threads.emplace_back(
            [&]
            {
                for (int i = 0; i < perProducer;)
                {
                    queue.AddMessage(1) ? static_cast<void>(++i) : std::this_thread::yield();
                }
            });
    }
    std::atomic<int> taken{0};
    for (int c = 0; c < 2; ++c)
    {
        threads.emplace_back(
            [&]
            {
                int message = 0;
                while (taken < producers * perProducer)
                {
                    queue.GetMessage(message) ? static_cast<void>(++taken) : std::this_thread::yield();
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
    EXPECT_EQ(taken, producers * perProducer);
    EXPECT_TRUE(queue.IsEmpty());
}

TEST(SafeQueue, IsFirstInFirstOutUpToItsSize)
{
    SafeQueue<int> queue(2);
    EXPECT_EQ(queue.GetMaxQueueSize(), 2);
    EXPECT_TRUE(queue.empty());
    EXPECT_TRUE(queue.enqueue(1));
    EXPECT_TRUE(queue.enqueue(2));
    EXPECT_FALSE(queue.enqueue(3));
    EXPECT_EQ(queue.size(), 2);
    int element = 0;
    EXPECT_TRUE(queue.dequeue(element));
    EXPECT_EQ(element, 1);
    queue.clear();
    EXPECT_FALSE(queue.dequeue(element));
    EXPECT_EQ(element, 1);
}

TEST(SafeQueue, MayBeAskedWhetherItIsEmptyWhileOthersUseIt)
{
    SafeQueue<int> queue(16);
    std::thread other(
        [&]
        {
            for (int i = 0; i < 10000; ++i)
            {
                int element = 0;
                queue.enqueue(i);
                queue.dequeue(element);
            }
        });
    int emptyCount = 0;
    for (int i = 0; i < 10000; ++i)
    {
        emptyCount += queue.empty() ? 1 : 0;
    }
    other.join();
    EXPECT_TRUE(queue.empty());
    EXPECT_GE(emptyCount, 0);
}

}  // namespace
