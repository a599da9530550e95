#include "manager/NodeSecurity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "keys/FleetAuthority.h"
#include "keys/MemberPermissions.h"

namespace Rabit
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

constexpr std::time_t Day = 24 * 60 * 60;

// A backend that the tests never ask to open a session.
class UnusedTransport : public Transport
{
public:
    std::string Name() const override { return "unused"; }
    std::unique_ptr<TransportSession> Open(const TransportSettings &, PeerHandler) override
    {
        return nullptr;
    }
};

class NodeSecurity : public testing::Test
{
protected:
    NodeSecurity()
        : Root(testing::TempDir() + "rabit-node-security-" + std::to_string(::getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name())
    {
        std::filesystem::create_directories(Root);
        Config.Node = "uav1";
        Config.Domain = 7;
        Config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose"});
        Config.Security = {.Keys = Root + "/keys/uav1"};
        Config.File = "uav1.yaml";
        Config.Lines = {{"security", 5}};
    }
    ~NodeSecurity() override { std::filesystem::remove_all(Root); }

    void Make(int days = 365, std::time_t now = std::time(nullptr)) const
    {
        Keys::FleetAuthority::Init(Root + "/keys");
        Keys::FleetAuthority(Root + "/keys")
            .Add({.Node = "uav1", .Allowed = Keys::PermissionsFor(AccessOf(Config))},
                 {.Now = now, .Days = days});
    }
    std::string WhyNot() const
    {
        try
        {
            CheckTransportSettings(Config, UnusedTransport());
            return "";
        }
        catch (const ConfigError &error)
        {
            return error.what();
        }
    }

    const std::string Root;
    GatewayConfig Config;
    NodeMembers Members;
};

TEST_F(NodeSecurity, WithoutItNothingIsAsked)
{
    Config.Security.reset();
    TransportSettings settings;
    AddSecurity(Config, settings, Members);
    EXPECT_FALSE(settings.Member);
}

TEST_F(NodeSecurity, AMemberIsHandedToTheTransport)
{
    Make();
    EXPECT_EQ(WhyNot(), "");
    TransportSettings settings;
    AddSecurity(Config, settings, Members);
    ASSERT_TRUE(settings.Member);
    EXPECT_EQ(settings.Member->Name(), "uav1");
}

TEST_F(NodeSecurity, OneMemberServesAllPaths)
{
    Make();
    TransportSettings first;
    TransportSettings second;
    AddSecurity(Config, first, Members);
    AddSecurity(Config, second, Members);
    EXPECT_EQ(first.Member, second.Member);
}

TEST_F(NodeSecurity, ThatThereAreNoKeysIsSaidWithFileAndLine)
{
    EXPECT_THAT(WhyNot(), HasSubstr("uav1.yaml:5: there is no folder of keys"));
}

TEST_F(NodeSecurity, AFolderThatTheSystemDoesNotShowIsSaidWithFileAndLine)
{
    // No file system has such a name. A folder of another user would fail for others than root alone.
    Config.Security->Keys = Root + "/" + std::string(300, 'x');
    EXPECT_THAT(WhyNot(), HasSubstr("uav1.yaml:5: the folder of keys "));
}

TEST_F(NodeSecurity, KeysOfAFormerFormatAreRefusedWithFileAndLine)
{
    std::filesystem::create_directories(Config.Security->Keys);
    std::ofstream(Config.Security->Keys + "/certificate.pem") << "X.509";
    EXPECT_THAT(WhyNot(), AllOf(HasSubstr("uav1.yaml:5: "), HasSubstr("keys of a former format"),
                                HasSubstr("`rabit keys init`")));
}

TEST_F(NodeSecurity, AConfigurationThatNeedsMoreThanThePermissionsIsRefused)
{
    Make();
    Config.Publish.push_back({.Message = "Photo", .Type = "Uav::Pose"});
    EXPECT_THAT(WhyNot(), HasSubstr("does not allow what the configuration needs: write Photo;"));
}

TEST_F(NodeSecurity, AToolWithTheKeysOfANodeIsToldToUseItsOwn)
{
    Make();
    Config.Publish.clear();
    Config.Tool.emplace();
    EXPECT_THAT(WhyNot(), HasSubstr("a tool needs keys of its own"));
}

TEST_F(NodeSecurity, AnotherNameIsRefused)
{
    Make();
    Config.Node = "uav2";
    EXPECT_THAT(WhyNot(), HasSubstr("is for the node `uav1`, and this is `uav2`"));
}

TEST_F(NodeSecurity, AKeyThatOthersMayReadIsRefused)
{
    Make();
    std::filesystem::permissions(Config.Security->Keys + "/key", std::filesystem::perms(0640));
    EXPECT_THAT(WhyNot(), AllOf(HasSubstr("uav1.yaml:5: "), HasSubstr("not for its owner alone (mode 640)")));
}

TEST_F(NodeSecurity, AClockBeforeTheFirstDayKeepsNobodyFromStarting)
{
    Make(365, std::time(nullptr) + 30 * Day);
    EXPECT_EQ(WhyNot(), "");
}

TEST_F(NodeSecurity, KeysThatEndSoonAreAProblem)
{
    const std::time_t now = std::time(nullptr);
    Make(365, now);
    TransportSettings settings;
    AddSecurity(Config, settings, Members);
    EXPECT_TRUE(Members.Problems(now).empty());
    const std::vector<SettingsProblem> problems = Members.Problems(now + 340 * Day);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems.front().Setting, "keys");
    EXPECT_THAT(problems.front().Text, HasSubstr("the certificate of this node ends on "));
}

TEST_F(NodeSecurity, AfterItsEndTheNodeGoesOnWithOneProblem)
{
    const std::time_t now = std::time(nullptr);
    Make(1, now - 100 * Day);
    EXPECT_EQ(WhyNot(), "");
    TransportSettings settings;
    AddSecurity(Config, settings, Members);
    const std::vector<SettingsProblem> problems = Members.Problems(now);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems.front().Text, HasSubstr("ended on "));
}

class SecurityInAFile : public testing::Test
{
protected:
    ~SecurityInAFile() override { std::filesystem::remove(File); }
    std::string WhyNot(const std::string &text)
    {
        std::ofstream(File) << "node: uav1\n" << text;
        try
        {
            Config = LoadGatewayConfig(File);
            return "";
        }
        catch (const ConfigError &error)
        {
            return error.what();
        }
    }
    const std::string File = testing::TempDir() + "rabit-security-" + std::to_string(::getpid()) + ".yaml";
    GatewayConfig Config;
};

TEST_F(SecurityInAFile, IsRead)
{
    EXPECT_EQ(WhyNot("security: {keys: some/folder}\n"), "");
    ASSERT_TRUE(Config.Security);
    EXPECT_EQ(Config.Security->Keys, "some/folder");
}

TEST_F(SecurityInAFile, IsRefusedWithoutKeys)
{
    EXPECT_THAT(WhyNot("security: {}\n"), HasSubstr("keys"));
    EXPECT_THAT(WhyNot("security: {keys: ''}\n"), HasSubstr("keys"));
    EXPECT_THAT(WhyNot("security: {keys: a, key: b}\n"), HasSubstr("key"));
}

TEST_F(SecurityInAFile, ALevelIsToBeRemoved)
{
    const auto told =
        AllOf(HasSubstr(".yaml:"), HasSubstr("everything is encrypted and signed; remove `level`"));
    EXPECT_THAT(WhyNot("security: {keys: a, level: sign}\n"), told);
    EXPECT_THAT(WhyNot("security:\n  level: encrypt\n"), told);
    EXPECT_THAT(WhyNot("paths: [{name: mesh, security: {keys: a, level: sign}}]\n"), told);
}

TEST_F(SecurityInAFile, IsForEveryDomain)
{
    EXPECT_EQ(WhyNot("domain: 232\nsecurity: {keys: a}\n"), "");
}

TEST_F(SecurityInAFile, IsOfTheNetworkTooForProgramsThatAreOtherNodesInIt)
{
    std::ofstream(File) << "node: uav1\nsecurity: {keys: some/folder}\n";
    EXPECT_TRUE(LoadNetworkConfig(File).Security);
}

}  // namespace
}  // namespace Rabit
