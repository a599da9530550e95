#include "live/LiveQueue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "live/LiveProtocol.h"

namespace Rabit::Tool
{
namespace
{

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr std::size_t Size = 100;  // of a value, as it is sent

std::shared_ptr<const LiveValue> Value(std::uint32_t channel, std::uint64_t number,
                                       std::size_t size = Size - LiveProtocol::MessageDataHeader)
{
    return std::make_shared<const LiveValue>(LiveValue{channel, number, std::vector<std::uint8_t>(size)});
}

std::vector<std::uint64_t> TakeAll(LiveQueue &queue)
{
    std::vector<std::uint64_t> numbers;
    while (const auto value = queue.TakeValue())
    {
        numbers.push_back(value->What->Time);
    }
    return numbers;
}

TEST(LiveQueue, GivesValuesInTheOrderInWhichTheyCame)
{
    LiveQueue queue(10 * Size);
    queue.AddValue(1, Value(7, 1));
    queue.AddValue(2, Value(8, 2));
    queue.AddValue(1, Value(7, 3));
    EXPECT_EQ(queue.Bytes(), 3 * Size);
    EXPECT_THAT(TakeAll(queue), ElementsAre(1, 2, 3));
    EXPECT_EQ(queue.Bytes(), 0u);
    EXPECT_TRUE(queue.IsEmpty());
}

TEST(LiveQueue, TheOldestOfAChannelMakeRoomForItsNewest)
{
    LiveQueue queue(3 * Size);
    for (std::uint64_t number = 1; number <= 5; ++number)
    {
        queue.AddValue(1, Value(7, number));
    }
    EXPECT_THAT(queue.TakeDropped(), ElementsAre(Pair(7, 2)));
    EXPECT_THAT(TakeAll(queue), ElementsAre(3, 4, 5));
}

TEST(LiveQueue, AChannelTakesNoRoomFromAnother)
{
    LiveQueue queue(3 * Size);
    queue.AddValue(2, Value(8, 100));
    for (std::uint64_t number = 1; number <= 5; ++number)
    {
        queue.AddValue(1, Value(7, number));
    }
    queue.AddValue(3, Value(9, 200));
    EXPECT_THAT(queue.TakeDropped(), ElementsAre(Pair(7, 3), Pair(9, 1)));
    EXPECT_THAT(TakeAll(queue), ElementsAre(100, 4, 5));
}

TEST(LiveQueue, KeepsTheNewestValueOfAStateWhileOtherChannelsFillTheQueue)
{
    LiveQueue queue(3 * Size);
    for (std::uint64_t number = 1; number <= 3; ++number)
    {
        queue.AddValue(1, Value(7, number));
    }
    queue.AddState(2, Value(8, 100));
    queue.AddState(3, Value(8, 100));
    queue.AddState(2, Value(8, 101));
    queue.AddState(3, Value(8, 101));
    queue.AddState(4, Value(9, 200, 10 * Size));
    EXPECT_THAT(queue.TakeDropped(), ElementsAre(Pair(8, 2)));
    EXPECT_THAT(TakeAll(queue), ElementsAre(1, 2, 3, 101, 101, 200));
    EXPECT_EQ(queue.Bytes(), 0u);
}

TEST(LiveQueue, KeepsOlderValuesOfAStateWhileThereIsRoom)
{
    LiveQueue queue(3 * Size);
    for (std::uint64_t number = 1; number <= 5; ++number)
    {
        queue.AddState(1, Value(7, number));
    }
    EXPECT_THAT(queue.TakeDropped(), ElementsAre(Pair(7, 2)));
    EXPECT_THAT(TakeAll(queue), ElementsAre(3, 4, 5));
}

TEST(LiveQueue, WhatIsLargerThanAllIsDropped)
{
    LiveQueue queue(3 * Size);
    queue.AddValue(1, Value(7, 1, 4 * Size));
    EXPECT_THAT(queue.TakeDropped(), ElementsAre(Pair(7, 1)));
    EXPECT_THAT(queue.TakeDropped(), IsEmpty());
    EXPECT_TRUE(queue.IsEmpty());
}

TEST(LiveQueue, WhatIsNotWantedAnyMoreMakesRoom)
{
    LiveQueue queue(3 * Size);
    queue.AddValue(1, Value(7, 1));
    queue.AddValue(2, Value(7, 2));
    queue.Remove(1);
    EXPECT_EQ(queue.Bytes(), Size);
    EXPECT_THAT(TakeAll(queue), ElementsAre(2));
}

TEST(LiveQueue, ManyTextsThatNobodyReadsAreRefused)
{
    LiveQueue queue(Size);
    for (std::size_t i = 0; i < LiveQueue::MostTexts; ++i)
    {
        ASSERT_TRUE(queue.AddText("text"));
    }
    EXPECT_FALSE(queue.AddText("one more"));
}

}  // namespace
}  // namespace Rabit::Tool
