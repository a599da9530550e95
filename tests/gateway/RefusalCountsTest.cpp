// Messages that were refused at the call, under more names than are kept.
#include "queues/RefusalCounts.h"

#include <gtest/gtest.h>

#include <string>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class RefusalCountsTest : public ::testing::Test
{
protected:
    void Refuse(const std::string &node)
    {
        counts.Add(node, "Commands", QueueAcceptance::UnknownNode, "unknown", now);
    }
    // The links that are kept.
    std::map<RefusalCounts::LinkName, Gateway::LinkStatus> Rows() const
    {
        std::map<RefusalCounts::LinkName, Gateway::LinkStatus> rows;
        counts.Report(rows);
        return rows;
    }
    bool Has(const std::string &node) const { return Rows().count({node, "Commands"}) != 0; }
    // Refuses under as many names as are kept, one a millisecond.
    void Fill()
    {
        for (std::size_t i = 0; i < RefusalCounts::MostLinks; ++i, now += 1ms)
        {
            Refuse("uav" + std::to_string(i));
        }
    }

    RefusalCounts counts;
    RefusalCounts::Duration now = 100s;
};

TEST_F(RefusalCountsTest, NamesWithoutEndTakeNoMemoryWithoutEnd)
{
    Fill();
    Fill();
    for (int i = 0; i < 100; ++i)
    {
        Refuse("made up " + std::to_string(i));
    }
    EXPECT_EQ(Rows().size(), RefusalCounts::MostLinks);
    EXPECT_EQ(counts.Problems(now).size(), RefusalCounts::MostLinks);
}

TEST_F(RefusalCountsTest, ANameTooManyReplacesTheOneThatWasRefusedLongestAgo)
{
    Fill();
    Refuse("uav0");
    Refuse("made up");
    EXPECT_TRUE(Has("made up"));
    EXPECT_TRUE(Has("uav0"));
    EXPECT_FALSE(Has("uav1"));
}

TEST_F(RefusalCountsTest, ANameThatWasReplacedIsCountedAnew)
{
    Fill();
    Refuse("made up");
    Refuse("uav0");
    EXPECT_EQ(Rows().at({"uav0", "Commands"}).refused_unknown, 1u);
}

TEST_F(RefusalCountsTest, AKnownNameFindsItsPlaceInAFullTable)
{
    Fill();
    Refuse("uav0");
    EXPECT_EQ(Rows().at({"uav0", "Commands"}).refused_unknown, 2u);
    EXPECT_EQ(Rows().size(), RefusalCounts::MostLinks);
}

TEST_F(RefusalCountsTest, AMessageThatIsTakenEndsTheProblemAndKeepsTheCount)
{
    Refuse("uav1");
    Refuse("uav2");
    counts.Forgive("uav1", "Commands");
    ASSERT_EQ(counts.Problems(now).size(), 1u);
    EXPECT_EQ(counts.Problems(now)[0].node, "uav2");
    EXPECT_TRUE(Has("uav1"));
}

TEST_F(RefusalCountsTest, OfANodeThatIsForgottenNothingIsKept)
{
    Refuse("uav1");
    Refuse("uav2");
    counts.Forget("uav1");
    EXPECT_FALSE(Has("uav1"));
    EXPECT_TRUE(Has("uav2"));
    EXPECT_EQ(counts.Problems(now).size(), 1u);
}

TEST_F(RefusalCountsTest, ARefusalIsAProblemForAMinute)
{
    Refuse("uav1");
    EXPECT_EQ(counts.Problems(now + RefusalCounts::Memory - 1ns).size(), 1u);
    EXPECT_TRUE(counts.Problems(now + RefusalCounts::Memory).empty());
}

}  // namespace
}  // namespace Rabit
