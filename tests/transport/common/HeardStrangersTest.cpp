// Where nodes wait for an introduction.
#include "common/HeardStrangers.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace
{

using Rabit::Rtps::HeardStrangers;
using Rabit::Rtps::Place;

constexpr HeardStrangers::TimePoint StrangersStart{std::chrono::hours(1)};

Place StrangerNumber(int number)
{
    return {.Host = {10, 0, 0, static_cast<std::uint8_t>(number)}, .Port = 0};
}

TEST(StrangersThatWereHeard, AreForgottenAfterTheirLastDatagram)
{
    HeardStrangers strangers;
    strangers.Heard(StrangerNumber(1), StrangersStart);
    strangers.Heard(StrangerNumber(2), StrangersStart + std::chrono::seconds(1));
    EXPECT_THAT(strangers.Current(StrangersStart + HeardStrangers::Remembered),
                testing::ElementsAre(StrangerNumber(1), StrangerNumber(2)));
    EXPECT_THAT(
        strangers.Current(StrangersStart + HeardStrangers::Remembered + std::chrono::milliseconds(500)),
        testing::ElementsAre(StrangerNumber(2)));
}

TEST(StrangersThatWereHeard, AreTheLastOnesOfMany)
{
    HeardStrangers strangers;
    for (int number = 0; number <= static_cast<int>(HeardStrangers::Most); ++number)
    {
        strangers.Heard(StrangerNumber(number), StrangersStart + std::chrono::milliseconds(number));
    }
    const auto current = strangers.Current(StrangersStart + std::chrono::milliseconds(100));
    EXPECT_EQ(current.size(), HeardStrangers::Most);
    EXPECT_THAT(current, testing::Not(testing::Contains(StrangerNumber(0))));
}

}  // namespace
