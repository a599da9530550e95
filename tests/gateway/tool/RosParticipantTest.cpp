#include "RosParticipant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "RosSample.h"

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class RosParticipantTest : public ::testing::TestWithParam<std::size_t>
{
protected:
    RosParticipant participant;
};

TEST_P(RosParticipantTest, HasTheNamesOfItsNodesWithTheirNamespaces)
{
    const auto sample =
        RosSample(GetParam(), 2).AddNode("/", "talker", 1, 3).AddNode("/uav1", "camera", 0, 2);
    ASSERT_TRUE(participant.Read(sample.Bytes()));
    EXPECT_EQ(participant.Prefix, "0102030405060708090a0b0c");
    EXPECT_THAT(participant.Nodes, ElementsAre("/talker", "/uav1/camera"));
}

TEST_P(RosParticipantTest, MayHaveNoNodes)
{
    ASSERT_TRUE(participant.Read(RosSample(GetParam(), 0).Bytes()));
    EXPECT_EQ(participant.Prefix, "0102030405060708090a0b0c");
    EXPECT_THAT(participant.Nodes, IsEmpty());
}

TEST_P(RosParticipantTest, KeepsABoundedNumberOfNodes)
{
    RosSample sample(GetParam(), 100);
    for (int i = 0; i < 100; ++i)
    {
        sample.AddNode("/", "node" + std::to_string(i), 0, 0);
    }
    ASSERT_TRUE(participant.Read(sample.Bytes()));
    EXPECT_THAT(participant.Nodes, SizeIs(RosParticipant::MostNodes));
}

TEST_P(RosParticipantTest, ANumberThatTheBytesDoNotHoldIsRefused)
{
    const auto nodes = RosSample(GetParam(), 0xffffffff).AddNode("/", "talker", 0, 0);
    EXPECT_FALSE(participant.Read(nodes.Bytes()));
    EXPECT_EQ(participant.Prefix, "");
    auto gids = RosSample(GetParam(), 1).AddNode("/", "talker", 0, 0).Bytes();
    gids.back() = 0xff;  // the number of its writers
    EXPECT_FALSE(participant.Read(gids));
    EXPECT_THAT(participant.Nodes, IsEmpty());
}

TEST_P(RosParticipantTest, ASampleThatIsCutOffOrTooLongHasNoNodes)
{
    const auto whole = RosSample(GetParam(), 1).AddNode("/", "talker", 1, 1).Bytes();
    for (std::size_t size = 0; size < whole.size(); ++size)
    {
        participant.Read({whole.data(), size});
        EXPECT_THAT(participant.Nodes, IsEmpty()) << size;
    }
    auto longer = whole;
    longer.resize(whole.size() + 4);
    EXPECT_FALSE(participant.Read(longer));
}

TEST_P(RosParticipantTest, DamagedSamplesAreReadWithinTheirBytes)
{
    const auto good =
        RosSample(GetParam(), 2).AddNode("/", "talker", 1, 3).AddNode("/uav1", "camera", 0, 2).Bytes();
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round)
    {
        auto bad = good;
        for (int i = 0; i < 3; ++i)
        {
            bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
        }
        bad.resize(random() % 4 == 0 ? random() % bad.size() : bad.size());
        if (participant.Read(bad))
        {
            EXPECT_THAT(participant.Prefix, SizeIs(24));
        }
        EXPECT_LE(participant.Nodes.size(), RosParticipant::MostNodes);
    }
}

INSTANTIATE_TEST_SUITE_P(GidSizes, RosParticipantTest, ::testing::Values(16, 24));

}  // namespace
}  // namespace Rabit::Tool
