// Entries, and numbers, of keys, of which those used last are remembered.
#include "common/RecentNumbers.h"

#include <gtest/gtest.h>

#include <string>

#include "common/RecentMap.h"

namespace
{

using Rabit::RecentMap;
using Numbers = Rabit::RecentNumbers<std::string>;

TEST(RecentNumbers, AKeyKeepsItsNumber)
{
    Numbers numbers;
    const auto first = numbers.Of("10.0.0.1");
    EXPECT_TRUE(first.second);
    EXPECT_NE(numbers.Of("10.0.0.2").first, first.first);
    EXPECT_EQ(numbers.Of("10.0.0.1"), std::pair(first.first, false));
}

TEST(RecentNumbers, OnlyTheKeysUsedLastAreRemembered)
{
    Numbers numbers;
    const auto kept = numbers.Of("kept").first;
    numbers.Of("forgotten");
    for (int i = 0; i < 10'000; ++i)
    {
        numbers.Of(std::to_string(i));
        EXPECT_EQ(numbers.Of("kept"), std::pair(kept, false));
    }
    EXPECT_EQ(numbers.Size(), Numbers::Most);
    EXPECT_TRUE(numbers.Of("forgotten").second);
}

TEST(RecentNumbers, ANumberIsNeverGivenTwice)
{
    Numbers numbers;
    const auto first = numbers.Of("first").first;
    std::uint64_t last = first;
    for (int i = 0; i < 10'000; ++i)
    {
        const auto next = numbers.Of(std::to_string(i)).first;
        EXPECT_GT(next, last);
        last = next;
    }
    const auto again = numbers.Of("first");
    EXPECT_TRUE(again.second);
    EXPECT_GT(again.first, last);
}

TEST(RecentMap, ForgetsTheOldestEntry)
{
    RecentMap<int, char> map(2);
    map.Put(1, 'a');
    map.Put(2, 'b');
    map.Put(3, 'c');
    EXPECT_EQ(map.Size(), 2U);
    EXPECT_EQ(map.Find(1), nullptr);
    EXPECT_NE(map.Find(2), nullptr);
}

TEST(RecentMap, AnEntryThatIsPutAgainIsTheNewestAndHasTheNewValue)
{
    RecentMap<int, char> map(2);
    map.Put(1, 'a');
    map.Put(2, 'b');
    map.Put(1, 'c');
    map.Put(3, 'd');
    EXPECT_EQ(map.Find(2), nullptr);
    ASSERT_NE(map.Find(1), nullptr);
    EXPECT_EQ(*map.Find(1), 'c');
}

TEST(RecentMap, AnErasedEntryIsGone)
{
    RecentMap<int, char> map(2);
    map.Put(1, 'a');
    map.Erase(1);
    map.Erase(1);
    EXPECT_EQ(map.Find(1), nullptr);
    EXPECT_EQ(map.Size(), 0U);
}

}  // namespace
