#include "backfill/CredibleTime.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;

constexpr std::uint64_t PerSecond = 1'000'000'000;
constexpr std::uint64_t Now = 1'795'725'000 * PerSecond;

TEST(CredibleTimeTest, APostOfTheFutureIsNotCredible)
{
    EXPECT_TRUE(IsCredible(Now + PerSecond, Now, 60s));
    EXPECT_FALSE(IsCredible(Now + PerSecond + 1, Now, 60s));
    EXPECT_FALSE(IsCredible(~std::uint64_t{0}, Now, 60s));
}

TEST(CredibleTimeTest, APostThatCannotHaveBeenRequestedIsNotCredible)
{
    const std::uint64_t oldest = Now - (24 * 3600 + 60) * PerSecond;
    EXPECT_TRUE(IsCredible(oldest, Now, 60s));
    EXPECT_FALSE(IsCredible(oldest - 1, Now, 60s));
    EXPECT_FALSE(IsCredible(0, Now, 60s));
}

TEST(CredibleTimeTest, AClockThatBeginsIn1970IsCredible)
{
    EXPECT_TRUE(IsCredible(0, 5 * PerSecond, 60s));
}

}  // namespace
}  // namespace Rabit::Backfill
