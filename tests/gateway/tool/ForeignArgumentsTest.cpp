#include "ForeignArguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ForeignArgumentsTest : public ::testing::Test
{
protected:
    ForeignArgumentsTest()
    {
        std::filesystem::create_directories(folder / "std_msgs/msg");
        std::ofstream(folder / "std_msgs/msg/String.msg") << "string data\n";
        std::ofstream(folder / "shapes.idl") << "@final struct Shape { long x; };\n";
        packages.Idl = {folder.string()};
    }
    ~ForeignArgumentsTest() override
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }

    static std::string ReasonOf(const ForeignOptions &options, std::vector<std::string> what)
    {
        try
        {
            TakeForeign(options, what);
        }
        catch (const ConfigError &error)
        {
            return error.what();
        }
        return "";
    }

    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                         ("rabit-foreign-arguments-" + std::to_string(::getpid()));
    ForeignOptions packages;
};

TEST_F(ForeignArgumentsTest, ATopicOfRosHasItsNameOnTheWireAndItsTypeFromAPackage)
{
    packages.Types = {"std_msgs/msg/String", "std_msgs::msg::String"};
    std::vector<std::string> what{"uav1/Pose", "/chatter", "rt/words"};
    const std::vector<ForeignArgument> topics = TakeForeign(packages, what);
    EXPECT_THAT(what, ElementsAre("uav1/Pose"));
    ASSERT_THAT(topics, SizeIs(2));
    EXPECT_EQ(topics[0].Rule.Local, "rt/chatter");
    EXPECT_EQ(topics[0].Rule.Type, "std_msgs::msg::String");
    EXPECT_EQ(topics[0].Rule.Names, ForeignRule::WireNames::Ros2);
    EXPECT_EQ(topics[0].Type->Name(), "std_msgs::msg::String");
    EXPECT_EQ(topics[1].Rule.Local, "rt/words");
    EXPECT_NE(MessageTypeRegistry::Find("std_msgs::msg::String"), nullptr);
}

TEST_F(ForeignArgumentsTest, IfEachNameHasATypeAllAreTopics)
{
    const ForeignOptions options{.Types = {"Shape"}, .Idl = {(folder / "shapes.idl").string()}};
    std::vector<std::string> what{"Square"};
    const std::vector<ForeignArgument> topics = TakeForeign(options, what);
    EXPECT_THAT(what, IsEmpty());
    ASSERT_THAT(topics, SizeIs(1));
    EXPECT_EQ(topics[0].Rule.Local, "Square");
    EXPECT_EQ(topics[0].Rule.Names, ForeignRule::WireNames::Plain);
}

TEST_F(ForeignArgumentsTest, MessagesOfNodesAreNoTopics)
{
    std::vector<std::string> what{"uav1/Pose", "Pose"};
    EXPECT_THAT(TakeForeign({}, what), IsEmpty());
    EXPECT_THAT(what, SizeIs(2));
}

TEST_F(ForeignArgumentsTest, ATopicWithoutATypeOrATypeWithoutADefinitionIsAnError)
{
    EXPECT_THAT(ReasonOf(packages, {"/chatter"}), HasSubstr("expected its type"));
    packages.Types = {"std_msgs/msg/String"};
    EXPECT_THAT(ReasonOf(packages, {"/chatter", "/words"}), HasSubstr("found 1 for 2 topics"));
    EXPECT_THAT(ReasonOf(packages, {"uav1/Pose", "uav2/Pose"}), HasSubstr("found 1 for 0 topics"));
    packages.Types = {"std_msgs/msg/Wonder"};
    EXPECT_THAT(ReasonOf(packages, {"/chatter"}), HasSubstr("no definition of `std_msgs::msg::Wonder`"));
    packages.Idl = {(folder / "shapes.idl").string()};
    EXPECT_THAT(ReasonOf(packages, {"/chatter"}), HasSubstr("defines no message"));
}

TEST_F(ForeignArgumentsTest, AToolWithKeysReadsNoTopicOfProgramsWithout)
{
    packages.Types = {"std_msgs/msg/String"};
    std::vector<std::string> what{"/chatter"};
    const std::vector<ForeignArgument> topics = TakeForeign(packages, what);
    GatewayConfig config;
    config.Node = "tool";
    config.Tool.emplace();
    AddForeign(topics, config);
    EXPECT_THAT(config.Foreign, SizeIs(1));
    config.Foreign.clear();
    config.Security.emplace();
    config.Security->Keys = folder.string();
    EXPECT_THROW(AddForeign(topics, config), ConfigError);
}

}  // namespace
}  // namespace Rabit::Tool
