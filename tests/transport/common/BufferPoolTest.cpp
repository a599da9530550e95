#include "common/BufferPool.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <cstring>
#include <memory>
#include <thread>
#include <vector>

namespace Rabit
{
namespace
{

class BufferPoolTest : public testing::Test
{
protected:
    // Takes buffers of that size, writes to all of their bytes and gives them back.
    void Use(std::size_t count, std::uint32_t size)
    {
        std::vector<BufferPool::Buffer> buffers;
        for (std::size_t i = 0; i < count; ++i)
        {
            buffers.push_back(Pool.Acquire(size));
            EXPECT_GE(buffers.back().Capacity, size);
            std::memset(buffers.back().Data, 0x5a, buffers.back().Capacity);
        }
        for (const BufferPool::Buffer buffer : buffers)
        {
            Pool.Release(buffer);
        }
    }

    // True if a buffer that is given back is the next one of its size.
    bool IsKept(std::uint32_t size)
    {
        const BufferPool::Buffer first = Pool.Acquire(size);
        Pool.Release(first);
        // Would be at the place of a buffer that was freed.
        const auto other = std::make_unique<std::uint8_t[]>(first.Capacity);
        const BufferPool::Buffer second = Pool.Acquire(size);
        Pool.Release(second);
        return second.Data == first.Data;
    }

    BufferPool Pool;
};

TEST_F(BufferPoolTest, ABufferIsReusedForTheNextSampleOfItsSize)
{
    const BufferPool::Buffer first = Pool.Acquire(40'000);
    Pool.Release(first);
    const BufferPool::Buffer second = Pool.Acquire(33'000);
    EXPECT_EQ(second.Data, first.Data);
    Pool.Release(second);
}

TEST_F(BufferPoolTest, ASmallSampleDoesNotHoldTheBufferOfALargeOne)
{
    Use(1, 60'000);
    const BufferPool::Buffer small = Pool.Acquire(100);
    EXPECT_EQ(small.Capacity, 128U);
    Pool.Release(small);
}

TEST_F(BufferPoolTest, EverySizeUpToTheLargestSampleFits)
{
    for (const std::uint32_t size : {0U, 1U, 128U, 129U, 65'535U, 65'536U, 65'537U, 64U << 20})
    {
        Use(1, size);
    }
}

// Sanitizers report no bytes in use.
TEST_F(BufferPoolTest, OneMegabyteOfASizeIsKeptAtMost)
{
    Use(1, 60'000);
    const std::size_t before = mallinfo2().uordblks;
    Use(100, 60'000);
    EXPECT_LE(mallinfo2().uordblks, before + (1u << 20) + 100'000);
}

TEST_F(BufferPoolTest, ABurstOfOneSizeLeavesRoomForTheOthers)
{
    for (const std::uint32_t burst : {100U, 60'000U})
    {
        Use((2u << 20) / burst, burst);
    }
    for (const std::uint32_t size : {100U, 2000U, 60'000U})
    {
        EXPECT_TRUE(IsKept(size)) << size;
    }
}

TEST_F(BufferPoolTest, SeveralThreadsMayUseIt)
{
    std::vector<std::thread> threads;
    for (std::uint32_t size : {100U, 100U, 2000U})
    {
        threads.emplace_back(
            [this, size]
            {
                for (int i = 0; i < 1000; ++i)
                {
                    Use(3, size);
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
}

}  // namespace
}  // namespace Rabit
