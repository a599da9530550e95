#include "common/BufferPool.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <cstring>
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
TEST_F(BufferPoolTest, OneMegabyteIsKeptAtMost)
{
    Use(1, 60'000);
    const std::size_t before = mallinfo2().uordblks;
    Use(100, 60'000);
    EXPECT_LE(mallinfo2().uordblks, before + (1u << 20) + 100'000);
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
