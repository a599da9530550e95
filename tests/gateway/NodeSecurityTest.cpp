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
#include "keys/FleetKeys.h"
#include "keys/MemberPermissions.h"

namespace Rabit
{
namespace
{

using testing::HasSubstr;

constexpr std::time_t Day = 24 * 60 * 60;

// A backend that the tests never ask to open a session.
class NamedTransport : public Transport
{
public:
    explicit NamedTransport(std::string name) : _name(std::move(name)) {}
    std::string Name() const override { return _name; }
    std::unique_ptr<TransportSession> Open(const TransportSettings &, PeerHandler) override
    {
        return nullptr;
    }

private:
    const std::string _name;
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
        Config.Security = {.Keys = Root + "/keys/uav1", .Level = SecurityLevel::Encrypt};
        Config.File = "uav1.yaml";
        Config.Lines = {{"security", 5}};
    }
    ~NodeSecurity() override { std::filesystem::remove_all(Root); }

    void Make(std::time_t now = std::time(nullptr)) const
    {
        Keys::FleetKeys::Init(Root + "/keys", "blue", {now - 1000 * Day, 5000});
        Keys::FleetKeys(Root + "/keys")
            .Add({.Node = "uav1", .SmallGuid = false, .Access = AccessOf(Config)}, {now, 100});
    }
    std::string WhyNot(const std::string &transport = "fastdds") const
    {
        try
        {
            CheckTransportSettings(Config, NamedTransport(transport));
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
    EXPECT_EQ(AddSecurity(Config, "fastdds", settings, Members), std::nullopt);
    EXPECT_FALSE(settings.Security);
}

TEST_F(NodeSecurity, KeysThatFitTheConfigurationAreHandedToTheTransport)
{
    Make();
    EXPECT_EQ(WhyNot(), "");
    TransportSettings settings;
    EXPECT_TRUE(AddSecurity(Config, "fastdds", settings, Members));
    ASSERT_TRUE(settings.Security);
    EXPECT_EQ(settings.Security->Governance, Root + "/keys/uav1/governance_encrypt.p7s");
}

TEST_F(NodeSecurity, TheLevelChoosesTheGovernance)
{
    Make();
    Config.Security->Level = SecurityLevel::Sign;
    TransportSettings settings;
    AddSecurity(Config, "fastdds", settings, Members);
    EXPECT_EQ(settings.Security->Governance, Root + "/keys/uav1/governance_sign.p7s");
    EXPECT_FALSE(settings.Security->Encrypts);
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

TEST_F(NodeSecurity, AConfigurationThatNeedsMoreThanThePermissionsIsRefused)
{
    Make();
    Config.Publish.push_back({.Message = "Photo", .Type = "Uav::Pose"});
    EXPECT_THAT(WhyNot(), HasSubstr("does not allow what the configuration needs: write Photo of uav1;"));
}

TEST_F(NodeSecurity, AClockBeforeTheFirstDayIsSaidAndNothingElse)
{
    Make(std::time(nullptr) + 30 * Day);
    EXPECT_THAT(WhyNot(), HasSubstr("uav1.yaml:5: the clock says "));
    EXPECT_THAT(WhyNot(), HasSubstr("set the clock"));
}

TEST_F(NodeSecurity, AnotherBackendThanTheKeysAreForIsRefused)
{
    Make();
    EXPECT_THAT(WhyNot("cyclonedds"), HasSubstr("another DDS implementation"));
}

TEST_F(NodeSecurity, KeysThatEndSoonAreAProblem)
{
    constexpr std::time_t end = 1795435200;  // 2026-11-23
    EXPECT_EQ(KeysProblem(std::nullopt, end), std::nullopt);
    EXPECT_EQ(KeysProblem(end, end - 31 * Day), std::nullopt);
    ASSERT_TRUE(KeysProblem(end, end - 29 * Day));
    EXPECT_THAT(KeysProblem(end, end - 29 * Day)->reason, HasSubstr("ends on 2026-11-23"));
    EXPECT_THAT(KeysProblem(end, end + 1)->reason, HasSubstr("ended on 2026-11-23"));
}

class NodeMembership : public NodeSecurity
{
protected:
    void MakeNew(int days = 365, std::time_t now = std::time(nullptr)) const
    {
        Keys::FleetAuthority::Init(Root + "/keys");
        Keys::FleetAuthority(Root + "/keys")
            .Add({.Node = "uav1", .Allowed = Keys::PermissionsFor(AccessOf(Config))},
                 {.Now = now, .Days = days});
    }
};

TEST_F(NodeMembership, IsHandedToTheTransportInsteadOfDdsSecurity)
{
    MakeNew();
    TransportSettings settings;
    EXPECT_EQ(AddSecurity(Config, "cyclonedds", settings, Members), std::nullopt);
    ASSERT_TRUE(settings.Member);
    EXPECT_EQ(settings.Member->Name(), "uav1");
    EXPECT_FALSE(settings.Security);
}

TEST_F(NodeMembership, IsOneForAllPaths)
{
    MakeNew();
    TransportSettings first;
    TransportSettings second;
    AddSecurity(Config, "fastdds", first, Members);
    AddSecurity(Config, "cyclonedds", second, Members);
    EXPECT_EQ(first.Member, second.Member);
}

TEST_F(NodeMembership, HasNoLevelThatSignsAlone)
{
    MakeNew();
    Config.Security->Level = SecurityLevel::Sign;
    EXPECT_THAT(WhyNot(), HasSubstr("uav1.yaml:5: there is no `level: sign` with the keys in"));
}

TEST_F(NodeMembership, IsRefusedForMoreThanThePermissions)
{
    MakeNew();
    Config.Publish.push_back({.Message = "Photo", .Type = "Uav::Pose"});
    EXPECT_THAT(WhyNot(), HasSubstr("does not allow what the configuration needs: write Photo;"));
}

TEST_F(NodeMembership, IsRefusedUnderAnotherName)
{
    MakeNew();
    Config.Node = "uav2";
    EXPECT_THAT(WhyNot(), HasSubstr("is for the node `uav1`, and this is `uav2`"));
}

TEST_F(NodeMembership, ThatEndsSoonIsAProblem)
{
    const std::time_t now = std::time(nullptr);
    MakeNew(365, now);
    TransportSettings settings;
    AddSecurity(Config, "fastdds", settings, Members);
    EXPECT_TRUE(Members.Problems(now).empty());
    const std::vector<SettingsProblem> problems = Members.Problems(now + 340 * Day);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems.front().Setting, "keys");
    EXPECT_THAT(problems.front().Text, HasSubstr("the certificate of this node ends on "));
}

TEST_F(NodeMembership, GoesOnAfterItsEndWithOneProblem)
{
    const std::time_t now = std::time(nullptr);
    MakeNew(1, now - 100 * Day);
    EXPECT_EQ(WhyNot(), "");
    TransportSettings settings;
    AddSecurity(Config, "fastdds", settings, Members);
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
    EXPECT_EQ(WhyNot("security: {keys: some/folder, level: sign}\n"), "");
    ASSERT_TRUE(Config.Security);
    EXPECT_EQ(Config.Security->Keys, "some/folder");
    EXPECT_EQ(Config.Security->Level, SecurityLevel::Sign);
}

TEST_F(SecurityInAFile, EncryptsUnlessItIsToldOtherwise)
{
    EXPECT_EQ(WhyNot("security: {keys: some/folder}\n"), "");
    EXPECT_EQ(Config.Security->Level, SecurityLevel::Encrypt);
}

TEST_F(SecurityInAFile, IsRefusedWithoutKeysOrWithAnotherLevel)
{
    EXPECT_THAT(WhyNot("security: {level: sign}\n"), HasSubstr("keys"));
    EXPECT_THAT(WhyNot("security: {keys: ''}\n"), HasSubstr("keys"));
    EXPECT_THAT(WhyNot("security: {keys: a, level: none}\n"), HasSubstr("level"));
    EXPECT_THAT(WhyNot("security: {keys: a, key: b}\n"), HasSubstr("key"));
    EXPECT_THAT(WhyNot("domain: 231\nsecurity: {keys: a}\n"),
                HasSubstr("with security the domain must be 0 to 230"));
}

TEST_F(SecurityInAFile, IsOfTheNetworkTooForProgramsThatAreOtherNodesInIt)
{
    std::ofstream(File) << "node: uav1\nsecurity: {keys: some/folder}\n";
    EXPECT_TRUE(LoadNetworkConfig(File).Security);
}

}  // namespace
}  // namespace Rabit
