#include "backfill/PostAccess.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

GatewayConfig Recording()
{
    GatewayConfig config;
    config.Record.emplace();
    return config;
}

TEST(PostAccessTest, WithoutKeysEverybodyMayRequestPosts)
{
    GatewayConfig config = Recording();
    config.Paths = {{.Name = "mesh"}, {.Name = "modem"}};
    EXPECT_TRUE(MayRequestPosts(config, "ground"));
}

TEST(PostAccessTest, WithKeysNobodyMay)
{
    GatewayConfig config = Recording();
    config.Security.emplace();
    EXPECT_FALSE(MayRequestPosts(config, "ground"));
}

TEST(PostAccessTest, WithKeysOfAPathNobodyMay)
{
    GatewayConfig config = Recording();
    config.Paths = {{.Name = "mesh"}, {.Name = "modem", .Security = SecuritySettings()}};
    EXPECT_FALSE(MayRequestPosts(config, "ground"));
}

TEST(PostAccessTest, OnlyNamedNodesMay)
{
    GatewayConfig config = Recording();
    config.Security.emplace();
    config.Record->BackfillTo = {"ground*"};
    EXPECT_TRUE(MayRequestPosts(config, "ground2"));
    EXPECT_FALSE(MayRequestPosts(config, "uav2"));
}

}  // namespace
}  // namespace Rabit::Backfill
