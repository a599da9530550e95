#include <gtest/gtest.h>
#include <rabit/gateway/NamePattern.h>

#include <string>
#include <utility>
#include <vector>

namespace Rabit
{
namespace
{

TEST(NamePattern, MatchesAsDdsPartitionsDo)
{
    EXPECT_TRUE(MatchesPattern("uav1", "uav1"));
    EXPECT_TRUE(MatchesPattern("uav*", "uav1"));
    EXPECT_TRUE(MatchesPattern("uav*", "uav"));
    EXPECT_TRUE(MatchesPattern("*", "ground"));
    EXPECT_TRUE(MatchesPattern("uav?", "uav2"));
    EXPECT_TRUE(MatchesPattern("*.vision", "uav1.vision"));
    EXPECT_TRUE(MatchesPattern("u*v*n", "uav1.vision"));
    EXPECT_FALSE(MatchesPattern("uav1", "uav2"));
    EXPECT_FALSE(MatchesPattern("uav?", "uav12"));
    EXPECT_FALSE(MatchesPattern("uav*x", "uav1"));
    EXPECT_FALSE(MatchesPattern("", "uav1"));
}

TEST(NamePattern, AHostilePatternTakesNoExponentialTime)
{
    const std::string pattern = "*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b";
    EXPECT_FALSE(MatchesPattern(pattern, std::string(5000, 'a')));
}

TEST(NamePattern, KnowsNodeNames)
{
    EXPECT_TRUE(IsNodeName("uav1.vision-2_b"));
    EXPECT_FALSE(IsNodeName(""));
    EXPECT_FALSE(IsNodeName("uav/1"));
    EXPECT_FALSE(IsNodeName("uav*"));
    EXPECT_FALSE(IsNodeName("u v"));
    EXPECT_FALSE(IsNodeName(std::string(65, 'x')));
}

TEST(NamePattern, KnowsMessageNames)
{
    EXPECT_TRUE(IsMessageName("Gateway/Fleet"));
    EXPECT_TRUE(IsMessageName("Autopilot:ManagerStatusMessage"));
    EXPECT_FALSE(IsMessageName("/Pose"));
    EXPECT_FALSE(IsMessageName("Pose/"));
    EXPECT_FALSE(IsMessageName("a//b"));
    EXPECT_FALSE(IsMessageName("Po se"));
    EXPECT_FALSE(IsMessageName(""));
}

TEST(NamePatternTest, OnePatternCoversAnotherThatMatchesNoMore)
{
    for (const auto &[wider, pattern] : std::vector<std::pair<const char *, const char *>>{{"*", "*"},
                                                                                           {"*", "uav1"},
                                                                                           {"uav*", "uav1"},
                                                                                           {"uav*", "uav?"},
                                                                                           {"uav*", "uav1*"},
                                                                                           {"u*1", "uav*1"},
                                                                                           {"uav?", "uav?"},
                                                                                           {"uav?", "uav1"},
                                                                                           {"*a*", "*b*a*"},
                                                                                           {"?*", "?*?"}})
    {
        EXPECT_TRUE(CoversPattern(wider, pattern)) << wider << " " << pattern;
    }
    for (const auto &[wider, pattern] :
         std::vector<std::pair<const char *, const char *>>{{"uav1", "uav2"},
                                                            {"uav1", "uav?"},
                                                            {"uav?", "uav*"},
                                                            {"uav?*", "uav*"},
                                                            {"uav*", "*"},
                                                            {"u*1", "u*"},
                                                            {"*a*", "*b*"},
                                                            {"????????", "*"},
                                                            {"uav??", "uav?*"}})
    {
        EXPECT_FALSE(CoversPattern(wider, pattern)) << wider << " " << pattern;
    }
}

}  // namespace
}  // namespace Rabit
