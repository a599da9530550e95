#include "vision/World.h"

#include <gtest/gtest.h>

#include <string>

namespace
{
using Swarm::Between;
using Swarm::World;

std::string ErrorOf(const std::string &text)
{
    try
    {
        World::Parse(text, "world.yaml");
        return "";
    }
    catch (const Swarm::WorldError &error)
    {
        return error.what();
    }
}

TEST(World, IsReadFromYaml)
{
    const World world = World::Parse(
        "ground_m: 430\n"
        "targets:\n"
        "  - {latitude_deg: 47.5, longitude_deg: 8.5}\n"
        "  - {latitude_deg: 47.6, longitude_deg: 8.6, walk: {speed_mps: 2, heading_deg: 90, length_m: 50}}\n",
        "world.yaml");
    EXPECT_EQ(world.GroundM, 430);
    ASSERT_EQ(world.Targets.size(), 2u);
    EXPECT_EQ(world.Targets[0].Start.LatitudeDeg, 47.5);
    EXPECT_EQ(world.Targets[1].LengthM, 50);
}

TEST(World, ATargetWithoutAWalkStands)
{
    const World world =
        World::Parse("{ground_m: 0, targets: [{latitude_deg: 47.5, longitude_deg: 8.5}]}", "");
    EXPECT_EQ(world.Targets[0].At(1.4e9).LatitudeDeg, 47.5);
}

TEST(World, AWalkingTargetGoesThereAndBack)
{
    Swarm::WorldTarget target{{47.5, 8.5, 0}, 2, 0, 50};
    EXPECT_NEAR(Between(target.Start, target.At(0)).NorthM, 0, 1e-6);
    EXPECT_NEAR(Between(target.Start, target.At(20)).NorthM, 40, 1e-6);
    EXPECT_NEAR(Between(target.Start, target.At(30)).NorthM, 40, 1e-6);
    EXPECT_NEAR(Between(target.Start, target.At(50 + 1)).NorthM, 2, 1e-6);
}

TEST(World, ABadFileIsOneLineWithItsPlace)
{
    EXPECT_EQ(ErrorOf("ground_m: 430\ntargets:\n  - {latitude_deg: 47.5}\n"),
              "world.yaml:3: longitude_deg is missing");
    EXPECT_EQ(ErrorOf("ground_m: high\ntargets: []\n"),
              "world.yaml:1: ground_m is not a number from -500 to 9000");
    EXPECT_EQ(ErrorOf("ground_m: 1\ntargets: []\nsky: blue\n"), "world.yaml:3: unknown key `sky`");
    EXPECT_EQ(ErrorOf("ground_m: 1\ntargets: 7\n"), "world.yaml:2: targets is not a list");
    EXPECT_EQ(ErrorOf("ground_m: 1\n"), "world.yaml:1: targets is not a list");
    EXPECT_EQ(ErrorOf("ground_m: .nan\ntargets: []\n"),
              "world.yaml:1: ground_m is not a number from -500 to 9000");
    EXPECT_EQ(ErrorOf(""), "world.yaml:1: the file is not a map");
    EXPECT_EQ(ErrorOf("ground_m: 1\ntargets: [{latitude_deg: 1, longitude_deg: 2, walk: {speed_mps: 0, "
                      "heading_deg: 0, length_m: 5}}]\n"),
              "world.yaml:2: speed_mps is not a number from 0.01 to 100");
    EXPECT_EQ(ErrorOf("ground_m: [\n").substr(0, 11), "world.yaml:");
}

TEST(World, AFileThatIsNotThereIsOneLine)
{
    try
    {
        World::Load("/nowhere/world.yaml");
        FAIL();
    }
    catch (const Swarm::WorldError &error)
    {
        EXPECT_STREQ(error.what(), "/nowhere/world.yaml: cannot be read");
    }
}

}  // namespace
