// How much memory received samples take.
#include "PayloadPool.h"

#include <gtest/gtest.h>

#include <deque>

namespace
{

using Rabit::FastDds::MaxSample;
using Rabit::FastDds::PayloadPool;

class PayloadPoolTest : public testing::Test
{
protected:
    bool Get(std::uint32_t size)
    {
        if (!Pool.get_payload(size, Changes.emplace_back()))
        {
            Changes.pop_back();
            return false;
        }
        return true;
    }
    void GiveBack()
    {
        Pool.release_payload(Changes.front());
        Changes.pop_front();
    }
    ~PayloadPoolTest() override
    {
        while (!Changes.empty())
        {
            GiveBack();
        }
    }

    int Refused = 0;
    PayloadPool Pool{[this] { ++Refused; }};
    std::deque<PayloadPool::Change> Changes;
};

TEST_F(PayloadPoolTest, ASampleLargerThanTheLargestIsRefused)
{
    EXPECT_TRUE(Get(MaxSample));
    EXPECT_FALSE(Get(MaxSample + 1));
    EXPECT_EQ(Refused, 1);
}

TEST_F(PayloadPoolTest, SamplesWhoseRestNeverComesDoNotFillTheMemory)
{
    for (int i = 0; i < 2; ++i)
    {
        EXPECT_TRUE(Get(MaxSample)) << i;
    }
    EXPECT_FALSE(Get(1000));
    EXPECT_EQ(Refused, 1);
    GiveBack();
    EXPECT_TRUE(Get(MaxSample));
}

// The vendor's change beside each of them takes memory as well.
TEST_F(PayloadPoolTest, SmallSamplesWhoseRestNeverComesDoNotFillTheMemory)
{
    const std::size_t most = PayloadPool::MostArriving / 512;
    while (Changes.size() < 2 * most && Get(100))
    {
    }
    EXPECT_EQ(Refused, 1);
    EXPECT_LE(Changes.size(), most);
}

// The vendor notes the place of a missing fragment in the first four bytes of it, rounded up to four.
TEST_F(PayloadPoolTest, ABufferHasRoomForTheVendorsListOfFragments)
{
    for (const std::uint32_t size : {127u, 128u, 256u, 65536u, 1u << 20})
    {
        ASSERT_TRUE(Get(size));
        EXPECT_GE(Changes.back().serializedPayload.max_size, size + 4) << size;
    }
}

// CVE-2025-62799: the last fragment may be shorter than its mark, and begin anywhere.
TEST_F(PayloadPoolTest, ABufferHasRoomForTheMarkOfAShortLastFragment)
{
    for (const std::uint32_t near : {128u, 1024u, 65536u, 100'000u})
    {
        for (std::uint32_t size = near - 8; size <= near + 8; ++size)
        {
            ASSERT_TRUE(Get(size));
            for (std::uint32_t fragment = 64; fragment < 128; ++fragment)
            {
                const std::uint32_t last = (size - 1) / fragment * fragment;
                const std::uint32_t endOfMark = (last + 3) / 4 * 4 + 4;
                ASSERT_LE(endOfMark, Changes.back().serializedPayload.max_size) << size << ' ' << fragment;
            }
        }
    }
}

TEST_F(PayloadPoolTest, WhatIsGivenBackCountsNoMore)
{
    for (int i = 0; i < 100'000; ++i)
    {
        ASSERT_TRUE(Get(20'000)) << i;
        GiveBack();
    }
    EXPECT_EQ(Refused, 0);
}

}  // namespace
