#include "recording/replay/NodeRenames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Replay
{
namespace
{

using ::testing::HasSubstr;

TEST(NodeRenames, ANodeThatNoRuleNamesGetsAPrefix)
{
    EXPECT_EQ(NodeRenames().NewNameOf("uav1.vision"), "replay.uav1.vision");
    EXPECT_EQ(NodeRenames().RuledNameOf("uav1"), "uav1");
}

TEST(NodeRenames, TheFirstRuleThatFitsHolds)
{
    NodeRenames renames;
    ASSERT_EQ(renames.Add("uav1=old"), "");
    ASSERT_EQ(renames.Add("uav*=x.*.y"), "");
    ASSERT_EQ(renames.Add("*=*"), "");
    EXPECT_EQ(renames.NewNameOf("uav1"), "old");
    EXPECT_EQ(renames.NewNameOf("uav12"), "x.12.y");
    EXPECT_EQ(renames.NewNameOf("uav"), "x..y");
    EXPECT_EQ(renames.NewNameOf("ground"), "ground");
    EXPECT_EQ(renames.RuledNameOf("uav1"), "old");
}

TEST(NodeRenames, AStarStandsForWhatItStandsForAtTheEndInTheMiddleAndAtTheBeginning)
{
    NodeRenames renames;
    ASSERT_EQ(renames.Add("a*z=b*y"), "");
    ASSERT_EQ(renames.Add("*.vision=*.eyes"), "");
    EXPECT_EQ(renames.NewNameOf("amz"), "bmy");
    EXPECT_EQ(renames.NewNameOf("uav1.vision"), "uav1.eyes");
}

TEST(NodeRenames, WhatIsNoRuleIsRefusedWithAReason)
{
    NodeRenames renames;
    for (const char *rule : {"", "uav1", "=", "uav1=", "=uav1", "uav1=a b", "u/v=w", "a=b=c"})
    {
        EXPECT_THAT(renames.Add(rule), HasSubstr("renames no node; expected OLD=NEW")) << rule;
    }
    for (const char *rule : {"uav*=x", "x=uav*", "*a*=*b*"})
    {
        EXPECT_THAT(renames.Add(rule), HasSubstr("one `*` on both sides, or none")) << rule;
    }
    EXPECT_EQ(renames.NewNameOf("uav1"), "replay.uav1") << "nothing of it holds";
}

}  // namespace
}  // namespace Rabit::Replay
