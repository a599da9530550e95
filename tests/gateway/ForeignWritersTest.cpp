// The writers of a foreign topic: their numbers, and more of them than are kept.
#include "foreign/ForeignWriters.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

WriterId Id(std::size_t writer)
{
    return {static_cast<std::uint8_t>(writer), static_cast<std::uint8_t>(writer / 256)};
}

class ForeignWritersTest : public ::testing::Test
{
protected:
    // Takes a sample of each of as many writers as are kept, one a millisecond.
    void Fill()
    {
        for (std::size_t i = 0; i < ForeignWriters::Most; ++i, now += 1ms)
        {
            EXPECT_TRUE(writers.IsNew(Id(i), 1, now));
        }
    }
    std::size_t Kept(std::size_t ofTheFirst) const
    {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < ofTheFirst; ++i)
        {
            kept += writers.Find(Id(i)) != nullptr ? 1 : 0;
        }
        return kept;
    }

    ForeignWriters writers;
    ForeignWriters::Duration now = 100s;
};

TEST_F(ForeignWritersTest, AThousandWritersTakeThePlaceOfSixtyFour)
{
    for (std::size_t i = 0; i < 1000; ++i, now += 1ms)
    {
        EXPECT_TRUE(writers.IsNew(Id(i), 1, now));
    }
    EXPECT_EQ(Kept(1000), ForeignWriters::Most);
    EXPECT_NE(writers.Find(Id(999)), nullptr);
}

TEST_F(ForeignWritersTest, AWriterTooManyReplacesTheOneThatWasSilentForLongest)
{
    Fill();
    EXPECT_TRUE(writers.IsNew(Id(0), 2, now));
    EXPECT_TRUE(writers.IsNew(Id(999), 1, now));
    EXPECT_NE(writers.Find(Id(0)), nullptr);
    EXPECT_EQ(writers.Find(Id(1)), nullptr);
    EXPECT_EQ(Kept(ForeignWriters::Most), ForeignWriters::Most - 1);
}

TEST_F(ForeignWritersTest, ARepeatedSampleKeepsNoWriterInTheTable)
{
    Fill();
    EXPECT_FALSE(writers.IsNew(Id(0), 1, now));
    EXPECT_TRUE(writers.IsNew(Id(999), 1, now));
    EXPECT_EQ(writers.Find(Id(0)), nullptr);
}

TEST_F(ForeignWritersTest, TheSamplesMissedOfAWriterThatIsReplacedStayCounted)
{
    EXPECT_TRUE(writers.IsNew(Id(999), 1, now));
    EXPECT_TRUE(writers.IsNew(Id(999), 5, now));
    now += 1s;
    Fill();
    EXPECT_EQ(writers.Find(Id(999)), nullptr);
    EXPECT_EQ(writers.Missed(), 3u);
}

}  // namespace
}  // namespace Rabit
