#include "queues/LinkPayloadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace Rabit
{
namespace
{

TEST(LinkPayloadPool, MemoryThatNobodyHoldsIsUsedAgain)
{
    const auto pool = std::make_shared<LinkPayloadPool>();
    const std::uint8_t *const first = pool->Make(100)->Writable().data();
    EXPECT_EQ(pool->Make(90)->Writable().data(), first);
}

TEST(LinkPayloadPool, MemoryThatIsHeldIsNotUsedAgain)
{
    const auto pool = std::make_shared<LinkPayloadPool>();
    const LinkPayload held = pool->Make(100);
    EXPECT_NE(pool->Make(100)->View().data(), held->View().data());
}

TEST(LinkPayloadPool, PayloadsOfEverySizeAreAsLongAsAsked)
{
    const auto pool = std::make_shared<LinkPayloadPool>();
    for (int round = 0; round < 2; ++round)
    {
        for (const std::size_t size : {0U, 1U, 63U, 64U, 65U, 4096U, 4097U, 1U << 20, (1U << 20) + 1})
        {
            const std::shared_ptr<LinkBytes> bytes = pool->Make(size);
            ASSERT_EQ(bytes->Size(), size);
            std::fill(bytes->Writable().begin(), bytes->Writable().end(), std::uint8_t{0xee});
        }
    }
}

TEST(LinkPayloadPool, APayloadOutlivesWhoeverMadeThePool)
{
    auto pool = std::make_shared<LinkPayloadPool>();
    const std::shared_ptr<LinkBytes> bytes = pool->Make(10);
    pool.reset();
    std::fill(bytes->Writable().begin(), bytes->Writable().end(), std::uint8_t{1});
    EXPECT_EQ(bytes->View()[9], 1);
}

TEST(LinkPayloadPool, WhatOneThreadGivesBackAnotherTakes)
{
    const auto pool = std::make_shared<LinkPayloadPool>();
    const auto work = [&pool](std::uint8_t mark, bool &intact)
    {
        std::vector<std::shared_ptr<LinkBytes>> held(8);
        for (std::size_t i = 0; i < 5000; ++i)
        {
            std::shared_ptr<LinkBytes> &slot = held[i % held.size()];
            intact = intact && (!slot || std::all_of(slot->View().begin(), slot->View().end(),
                                                     [mark](std::uint8_t byte) { return byte == mark; }));
            slot = pool->Make(1 + i % 200);
            std::fill(slot->Writable().begin(), slot->Writable().end(), mark);
        }
    };
    bool first = true;
    bool second = true;
    std::thread other(work, std::uint8_t{1}, std::ref(first));
    work(2, second);
    other.join();
    EXPECT_TRUE(first);
    EXPECT_TRUE(second);
}

}  // namespace
}  // namespace Rabit
