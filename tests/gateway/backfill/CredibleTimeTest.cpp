#include "backfill/CredibleTime.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;

constexpr std::uint64_t Second = 1'000'000'000;
constexpr std::uint64_t Now = 1'795'725'000 * Second;

TEST(CredibleTimeTest, APostOfTheFutureIsNotCredible)
{
    EXPECT_TRUE(IsCredible(Now + Second, Now, 60s));
    EXPECT_FALSE(IsCredible(Now + Second + 1, Now, 60s));
    EXPECT_FALSE(IsCredible(~std::uint64_t{0}, Now, 60s));
}

TEST(CredibleTimeTest, APostThatCannotHaveBeenRequestedIsNotCredible)
{
    const std::uint64_t oldest = Now - (24 * 3600 + 60) * Second;
    EXPECT_TRUE(IsCredible(oldest, Now, 60s));
    EXPECT_FALSE(IsCredible(oldest - 1, Now, 60s));
    EXPECT_FALSE(IsCredible(0, Now, 60s));
}

TEST(CredibleTimeTest, AClockThatBeginsIn1970IsCredible)
{
    EXPECT_TRUE(IsCredible(0, 5 * Second, 60s));
}

}  // namespace
}  // namespace Rabit::Backfill
