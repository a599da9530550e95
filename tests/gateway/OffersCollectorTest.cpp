#include "presence/OffersCollector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

using Outcome = OffersCollector::Outcome;

class OffersCollectorTest : public ::testing::Test
{
protected:
    OffersCollectorTest()
    {
        std::iota(whole.begin(), whole.end(), std::uint8_t{0});
        digest = Announcements::DigestOf(whole);
    }

    Gateway::AnnouncementPart Part(std::size_t first, std::size_t size) const
    {
        Gateway::AnnouncementPart part;
        part.first = static_cast<std::uint16_t>(first);
        part.of = static_cast<std::uint16_t>(whole.size());
        part.bytes.assign(whole.begin() + static_cast<long>(first),
                          whole.begin() + static_cast<long>(first + size));
        return part;
    }

    std::vector<std::uint8_t> whole = std::vector<std::uint8_t>(250);
    std::uint32_t digest = 0;
    OffersCollector collector;
};

TEST_F(OffersCollectorTest, PutsPartsTogetherInWhateverOrderAndHoweverOftenTheyCome)
{
    EXPECT_EQ(collector.Add(digest, Part(200, 50)), Outcome::Incomplete);
    EXPECT_EQ(collector.Add(digest, Part(0, 100)), Outcome::Incomplete);
    EXPECT_EQ(collector.Add(digest, Part(0, 100)), Outcome::Incomplete);
    EXPECT_EQ(collector.Add(digest, Part(90, 110)), Outcome::Complete);
    EXPECT_EQ(collector.Bytes(), whole);
}

TEST_F(OffersCollectorTest, SaysFromWhereOnSomethingIsLacking)
{
    EXPECT_EQ(collector.FirstLacking(digest), 0);
    collector.Add(digest, Part(0, 100));
    EXPECT_EQ(collector.FirstLacking(digest), 100);
    collector.Add(digest, Part(150, 100));
    EXPECT_EQ(collector.FirstLacking(digest), 100);
    EXPECT_EQ(collector.FirstLacking(digest + 1), 0);
}

TEST_F(OffersCollectorTest, BeginsAnewWithAnotherAnnouncement)
{
    collector.Add(digest + 1, Part(0, 250));
    collector.Add(digest + 2, Part(0, 100));
    EXPECT_EQ(collector.Add(digest, Part(100, 150)), Outcome::Incomplete);
    EXPECT_EQ(collector.Add(digest, Part(0, 100)), Outcome::Complete);
}

TEST_F(OffersCollectorTest, BeginsAnewWhereTheWholeIsSaidToBeOfAnotherSize)
{
    Gateway::AnnouncementPart part = Part(0, 100);
    part.of = 100;
    EXPECT_EQ(collector.Add(digest, part), Outcome::Wrong);
    EXPECT_EQ(collector.Add(digest, Part(0, 250)), Outcome::Complete);
}

TEST_F(OffersCollectorTest, KeepsNothingOfWhatIsNotAsTheDigestSays)
{
    EXPECT_EQ(collector.Add(digest + 1, Part(0, 250)), Outcome::Wrong);
    EXPECT_TRUE(collector.Bytes().empty());
    EXPECT_EQ(collector.FirstLacking(digest + 1), 0);
}

}  // namespace
}  // namespace Rabit
