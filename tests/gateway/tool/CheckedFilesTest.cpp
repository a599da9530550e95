#include "CheckedFiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/ConfigError.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

class CheckedFilesTest : public ::testing::Test
{
protected:
    CheckedFilesTest()
    {
        const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
        _folder = std::filesystem::path(::testing::TempDir()) /
                  ("rabit-check-" + std::string(test->name()) + "-" + std::to_string(::getpid()));
        std::filesystem::create_directories(_folder);
    }

    ~CheckedFilesTest() override
    {
        std::error_code ignored;
        std::filesystem::remove_all(_folder, ignored);
    }

    std::string Write(const std::string &name, const std::string &text) const
    {
        const std::string file = (_folder / name).string();
        std::ofstream(file) << text;
        return file;
    }

    std::vector<GatewayConfig> Load(const CheckedFiles::Argument &argument,
                                    const std::vector<std::string> &idl = {})
    {
        return CheckedFiles::Load({argument}, IdlFiles(idl), _findings);
    }

    std::filesystem::path _folder;
    std::vector<FleetCheck::Finding> _findings;
};

TEST_F(CheckedFilesTest, AFileIsForTheNodesBeforeIt)
{
    EXPECT_THAT(CheckedFiles::Parse("uav.yaml").Nodes, IsEmpty());
    const auto argument = CheckedFiles::Parse("uav1,uav2=uav.yaml");
    EXPECT_EQ(argument.File, "uav.yaml");
    EXPECT_THAT(argument.Nodes, ElementsAre("uav1", "uav2"));
    const std::string odd = Write("a=b.yaml", "");
    EXPECT_EQ(CheckedFiles::Parse(odd).File, odd);
}

TEST_F(CheckedFilesTest, AFileOfTypesThatNobodyLinkedIsLoadedForEachNode)
{
    const auto fleet =
        Load({Write("uav.yaml", "publish:\n  - {message: M, type: No::Body}\n"), {"uav1", "uav2"}});
    ASSERT_THAT(fleet, SizeIs(2));
    EXPECT_EQ(fleet[1].Node, "uav2");
    EXPECT_THAT(_findings, IsEmpty());
}

TEST_F(CheckedFilesTest, ABadFileIsOneFindingWithItsLine)
{
    const std::string file = Write("uav.yaml", "node: a\npublish:\n  - {mesage: M, type: No::Body}\n");
    EXPECT_THAT(Load({file, {"uav1", "uav2"}}), IsEmpty());
    ASSERT_THAT(_findings, SizeIs(1));
    EXPECT_EQ(
        FleetCheck::LineOf(_findings[0]),
        file + ":3: unknown key `mesage` in a `publish` entry; did you mean `message`? (`uav1`, `uav2`)");
    EXPECT_EQ(_findings[0].Line, 3);
}

TEST_F(CheckedFilesTest, WhatIsNoNameOfATypeIsToldWithoutKnowingAny)
{
    const std::string file = Write("uav.yaml", "node: a\npublish:\n  - {message: M, type: \"Uav:Pose\"}\n");
    Load({file, {}});
    ASSERT_THAT(_findings, SizeIs(1));
    EXPECT_EQ(_findings[0].Text, "`Uav:Pose` is no name of an IDL type; expected one such as Uav::Pose");
}

TEST_F(CheckedFilesTest, TypesAreLookedUpWhereAFileHasThem)
{
    const std::string idl = Write("my.idl", "module My {\nstruct Pose { long a; };\n};\n");
    EXPECT_THAT(Load({Write("a.yaml", "node: a\npublish:\n  - {message: M, type: My::Pose}\n"), {}}, {idl}),
                SizeIs(1));
    Load({Write("b.yaml", "node: b\npublish:\n  - {message: M, type: My::Poze}\n"), {}}, {idl});
    ASSERT_THAT(_findings, SizeIs(1));
    EXPECT_EQ(_findings[0].Text, "`" + idl + "` defines no message `My::Poze`; did you mean `My::Pose`?");
}

TEST_F(CheckedFilesTest, ATypeOfAFileHasTheDefinitionThatProgramsAreBuiltWith)
{
    const std::string idl = Write("my.idl",
                                  "// Positions.\nmodule My {\n@final struct Other { long b; };\n"
                                  "@final struct Pose { long a; };  // where\n};\n");
    const ParsedType pose = IdlFiles({idl}).Find("My::Pose");
    ASSERT_TRUE(pose.Type) << pose.Reason;
    EXPECT_EQ(pose.Type->IdlText(), "module My {\n@final\nstruct Pose {\n    long a;\n};\n};\n");
}

TEST_F(CheckedFilesTest, AFileThatIsNoIdlIsNamedWithItsLine)
{
    const std::string idl = Write("my.idl", "module My {\nstruct Pose { long };\n};\n");
    try
    {
        const IdlFiles types({idl});
        FAIL() << "it was loaded";
    }
    catch (const ConfigError &error)
    {
        EXPECT_THAT(error.what(), StartsWith(idl + ":2: "));
    }
}

TEST_F(CheckedFilesTest, AFileWithoutANodeNeedsOne)
{
    const std::string file = Write("a.yaml", "publish: []\n");
    EXPECT_THAT(Load({file, {}}), IsEmpty());
    ASSERT_THAT(_findings, SizeIs(1));
    EXPECT_EQ(_findings[0].Text, "the configuration needs the key `node`");
}

}  // namespace
}  // namespace Rabit::Tool
