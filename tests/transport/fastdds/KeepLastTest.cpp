// Which samples `KeepLast` keeps of each instance, and that it finds them without a search.
#include "KeepLast.h"

#include <gtest/gtest.h>

namespace
{

// A key that counts how often it is compared or hashed.
struct Counted
{
    int Number = 0;

    bool operator==(const Counted &other) const
    {
        ++Looks;
        return Number == other.Number;
    }

    static inline std::size_t Looks = 0;
};

struct HashOf
{
    std::size_t operator()(const Counted &key) const
    {
        ++Counted::Looks;
        return static_cast<std::size_t>(key.Number);
    }
};

using Kept = Rabit::FastDds::KeepLast<Counted, HashOf>;

// Adds a sample as a history does. Returns the number of the sample that it pushed out.
std::optional<std::uint64_t> Write(Kept &kept, int instance, std::uint64_t number)
{
    const auto out = kept.PushedOut({instance});
    if (out)
    {
        kept.Remove({instance}, *out);
    }
    kept.Add({instance}, number);
    return out;
}

TEST(KeepLast, TheOldestOfTheInstanceIsPushedOutWhenThereAreAsManyAsTheDepth)
{
    Kept kept(2);
    EXPECT_EQ(Write(kept, 1, 1), std::nullopt);
    EXPECT_EQ(Write(kept, 2, 2), std::nullopt);
    EXPECT_EQ(Write(kept, 1, 3), std::nullopt);
    EXPECT_EQ(Write(kept, 1, 4), 1u);
    EXPECT_EQ(Write(kept, 1, 5), 3u);
    EXPECT_EQ(Write(kept, 2, 6), std::nullopt);
    EXPECT_EQ(Write(kept, 2, 7), 2u);
}

TEST(KeepLast, WithADepthOfOneEachPushesOutTheOneBefore)
{
    Kept kept(1);
    EXPECT_EQ(Write(kept, 1, 1), std::nullopt);
    EXPECT_EQ(Write(kept, 1, 2), 1u);
    EXPECT_EQ(Write(kept, 1, 3), 2u);
}

TEST(KeepLast, WhatWasDroppedMakesRoomWhereverItWas)
{
    for (const std::uint64_t dropped : {1u, 2u, 3u})
    {
        Kept kept(3);
        Write(kept, 1, 1);
        Write(kept, 1, 2);
        Write(kept, 1, 3);
        kept.Remove({1}, dropped);
        EXPECT_EQ(Write(kept, 1, 4), std::nullopt) << dropped;
        EXPECT_EQ(Write(kept, 1, 5), dropped == 1 ? 2u : 1u) << dropped;
        EXPECT_EQ(Write(kept, 1, 6), dropped == 3 ? 2u : dropped == 1 ? 3u : 3u) << dropped;
    }
}

TEST(KeepLast, WhatIsNotThereCanBeDroppedWithoutHarm)
{
    Kept kept(2);
    kept.Remove({1}, 1);
    Write(kept, 1, 5);
    kept.Remove({1}, 4);
    kept.Remove({1}, 6);
    kept.Remove({2}, 5);
    EXPECT_EQ(Write(kept, 1, 7), std::nullopt);
    EXPECT_EQ(Write(kept, 1, 8), 5u);
}

TEST(KeepLast, AllThatIsDroppedFromTheNewestOnLeavesNothing)
{
    Kept kept(100);
    for (std::uint64_t number = 1; number <= 100; ++number)
    {
        Write(kept, 1, number);
    }
    for (std::uint64_t number = 100; number >= 1; --number)
    {
        kept.Remove({1}, number);
    }
    EXPECT_EQ(kept.PushedOut({1}), std::nullopt);
}

// An endless stream with a deep history.
TEST(KeepLast, TheOrderHoldsOverManySamples)
{
    Kept kept(100);
    for (std::uint64_t number = 1; number <= 10'000; ++number)
    {
        const auto out = Write(kept, 1, number);
        ASSERT_EQ(out, number > 100 ? std::optional(number - 100) : std::nullopt) << number;
    }
}

TEST(KeepLast, AnInstanceHasEndedUpToItsEndAndNoOther)
{
    Kept kept(5);
    Write(kept, 1, 1);
    Write(kept, 2, 2);
    Write(kept, 1, 3);
    EXPECT_FALSE(kept.HasEnded({1}, 1));
    Write(kept, 1, 4);
    kept.End({1}, 4);
    Write(kept, 1, 5);
    Write(kept, 3, 6);
    kept.End({3}, 6);
    for (const std::uint64_t number : {1u, 3u, 4u})
    {
        EXPECT_TRUE(kept.HasEnded({1}, number)) << number;
    }
    EXPECT_FALSE(kept.HasEnded({1}, 5));
    EXPECT_FALSE(kept.HasEnded({2}, 2));
}

TEST(KeepLast, TheOldestIsFoundOnlyUpToTheNumberThatIsAskedFor)
{
    Kept kept(5);
    EXPECT_EQ(kept.OldestUpTo({1}, 9), std::nullopt);
    Write(kept, 2, 1);
    Write(kept, 1, 3);
    Write(kept, 1, 4);
    EXPECT_EQ(kept.OldestUpTo({1}, 2), std::nullopt);
    EXPECT_EQ(kept.OldestUpTo({1}, 3), 3u);
    EXPECT_EQ(kept.OldestUpTo({1}, 9), 3u);
    kept.Remove({1}, 3);
    EXPECT_EQ(kept.OldestUpTo({1}, 9), 4u);
    kept.Remove({1}, 4);
    EXPECT_EQ(kept.OldestUpTo({1}, 9), std::nullopt);
}

TEST(KeepLast, NoKeyIsLookedAtWhileNothingHasEndedSoLate)
{
    Kept kept(1);
    kept.End({1}, 1);
    Write(kept, 2, 2);
    Counted::Looks = 0;
    EXPECT_FALSE(kept.HasEnded({2}, 2));
    EXPECT_EQ(Counted::Looks, 0u);
}

TEST(KeepLast, InstancesThatHaveEndedAreForgottenWhenTheyAreMany)
{
    Kept kept(1);
    for (int instance = 0; instance < 10'000; ++instance)
    {
        const auto number = static_cast<std::uint64_t>(instance) + 1;
        kept.Add({instance}, number);
        kept.End({instance}, number);
        kept.Remove({instance}, number);
    }
    EXPECT_LE(kept.Instances(), 257u);
}

TEST(KeepLast, InstancesWithoutSamplesAreForgottenWhenTheyAreMany)
{
    Kept kept(1);
    for (int instance = 0; instance < 10'000; ++instance)
    {
        Write(kept, instance, static_cast<std::uint64_t>(instance) + 1);
        kept.Remove({instance}, static_cast<std::uint64_t>(instance) + 1);
    }
    EXPECT_LE(kept.Instances(), 257u);
}

TEST(KeepLast, AWriteLooksAtAsManyKeysHoweverManyThereAre)
{
    const auto looksForAWrite = [](int instances)
    {
        Kept kept(4);
        std::uint64_t number = 0;
        for (int round = 0; round < 5; ++round)
        {
            for (int instance = 0; instance < instances; ++instance)
            {
                Write(kept, instance, ++number);
            }
        }
        Counted::Looks = 0;
        for (int instance = 0; instance < instances; ++instance)
        {
            Write(kept, instance, ++number);
        }
        return static_cast<double>(Counted::Looks) / instances;
    };
    const double few = looksForAWrite(10);
    EXPECT_LE(few, 10);
    EXPECT_LE(looksForAWrite(100'000), 2 * few);
}

}  // namespace
