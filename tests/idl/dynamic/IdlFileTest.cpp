#include <rabit/dynamic/IdlFile.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <locale>

namespace Rabit
{
namespace
{

// Writes 1400 as 1,400, as the locales of many languages do.
class DigitsInGroups : public std::numpunct<char>
{
protected:
    char do_thousands_sep() const override { return ','; }
    std::string do_grouping() const override { return "\3"; }
};

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class IdlFileTest : public ::testing::Test
{
protected:
    IdlFileTest() { std::filesystem::create_directories(folder / "shared"); }
    ~IdlFileTest() override { std::filesystem::remove_all(folder); }

    std::string Write(const std::string &name, const std::string &text) const
    {
        std::ofstream(folder / name) << text;
        return (folder / name).string();
    }
    std::string ReasonOf(const std::string &text) const
    {
        const IdlFile file = IdlFile::Load(Write("a.idl", text));
        EXPECT_THAT(file.Messages, IsEmpty());
        return file.Reason;
    }

    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("rabit_idl_file_" + std::to_string(getpid()));
};

TEST_F(IdlFileTest, AMessageHasTheTextThatTheGeneratorGivesIt)
{
    // As in uav.idl, with another layout and a constant.
    const IdlFile file = IdlFile::Load(Write("a.idl", R"(module Uav {
        const long Places = 64;
        @final struct GoHome { unsigned long id; string<Places> reply_to; string<2 * Places> reason; };
        };)"));
    EXPECT_THAT(file.Reason, IsEmpty());
    ASSERT_THAT(file.Messages, SizeIs(1));
    EXPECT_EQ(file.Messages[0]->Name(), "Uav::GoHome");
    EXPECT_EQ(file.Messages[0]->IdlText(), MessageTypeRegistry::Find("Uav::GoHome")->IdlText());
    ASSERT_THAT(file.Constants, SizeIs(1));
    EXPECT_EQ(file.Constants[0], std::make_pair(std::string("Uav::Places"), std::string("64")));
}

TEST_F(IdlFileTest, ALongFileIsTheSameInEachLocale)
{
    Write("point.idl", "module A { @nested @final struct Point { double x; }; };\n");
    const std::string text = std::string(1200, '\n') + "#include \"point.idl\"\n" +
                             "module B { @final struct Line { A::Point from; }; };\n";
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DigitsInGroups));
    const IdlFile file = IdlFile::Load(Write("a.idl", text));
    std::locale::global(before);
    EXPECT_THAT(file.Reason, IsEmpty());
    EXPECT_THAT(file.Messages, SizeIs(1));
}

TEST_F(IdlFileTest, AByteOrderMarkAtTheBeginningOfAFileIsNoPartOfTheText)
{
    const std::string mark = "\xEF\xBB\xBF";
    Write("point.idl", mark + "module A { @nested @final struct Point { double x; }; };\n");
    const IdlFile file = IdlFile::Load(
        Write("a.idl", mark + "#include \"point.idl\"\nmodule A { @final struct B { Point p; }; };\n"));
    EXPECT_THAT(file.Reason, IsEmpty());
    ASSERT_THAT(file.Messages, SizeIs(1));
    EXPECT_EQ(file.Messages[0]->Name(), "A::B");
}

TEST_F(IdlFileTest, FilesIncludeOthersOnceFromBesideThemAndFromFolders)
{
    Write("shared/point.idl",
          "#ifndef POINT\n#define POINT\nmodule A { @nested @final struct Point { double x; }; };\n"
          "#endif\n");
    Write("line.idl", "#include \"point.idl\"\nmodule A { @final struct Line { Point from; }; };\n");
    const IdlFile file = IdlFile::Load(
        Write("a.idl",
              "#pragma once\n#include <point.idl>\n#include \"line.idl\"\n"
              "module A {\n// A mark.\n@final struct Mark {\n    Point at;  // where\n};\n};\n"),
        {(folder / "shared").string()});
    EXPECT_THAT(file.Reason, IsEmpty());
    ASSERT_THAT(file.Messages, SizeIs(2));
    EXPECT_EQ(file.Messages[1]->Name(), "A::Mark");
    EXPECT_EQ(file.Comments.at("A::Mark"), "A mark.");
    EXPECT_EQ(file.Comments.at("A::Mark.at"), "where");
}

TEST_F(IdlFileTest, AReasonNamesFileAndLine)
{
    EXPECT_THAT(ReasonOf("module A {\nstruct B { wstring x; };\n};"), HasSubstr("a.idl:2: "));
    EXPECT_THAT(ReasonOf("module A {\n@final struct B { long x }\n};"), HasSubstr("a.idl:2: "));
    EXPECT_THAT(ReasonOf("\n#include \"none.idl\"\n"), EndsWith("a.idl:2: there is no file `none.idl`"));
    EXPECT_THAT(ReasonOf("#if 1\n#endif\n"), HasSubstr("a.idl:1: `#if 1` is not supported here"));
    EXPECT_THAT(ReasonOf("@unheard_of @final struct B { long x; };"),
                HasSubstr("@unheard_of is not supported"));
    EXPECT_THAT(IdlFile::Load((folder / "none.idl").string()).Reason, EndsWith("none.idl: cannot be read"));
}

TEST_F(IdlFileTest, AMsgFileOfRosIsItsMessageAndUsesThoseOfPackagesBesideIt)
{
    std::filesystem::create_directories(folder / "std_msgs/msg");
    std::filesystem::create_directories(folder / "builtin_interfaces/msg");
    Write("builtin_interfaces/msg/Time.msg", "int32 sec\nuint32 nanosec\n");
    const IdlFile header = IdlFile::Load(
        Write("std_msgs/msg/Header.msg", "builtin_interfaces/Time stamp\nstring frame_id  # of the data\n"));
    EXPECT_THAT(header.Reason, IsEmpty());
    ASSERT_THAT(header.Messages, SizeIs(2));
    EXPECT_EQ(header.Messages[1]->Name(), "std_msgs::msg::Header");
    const IdlFile text = IdlFile::Load(Write("std_msgs/msg/String.msg", "string data\n"));
    EXPECT_THAT(text.Reason, IsEmpty());
    ASSERT_THAT(text.Messages, SizeIs(1));
    EXPECT_EQ(text.Messages[0]->RosTypeHash(),
              "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
}

TEST_F(IdlFileTest, AReasonInAMsgFileNamesFileAndLine)
{
    std::filesystem::create_directories(folder / "a/msg");
    EXPECT_THAT(IdlFile::Load(Write("a/msg/B.msg", "string data\nwonder\n")).Reason, HasSubstr("B.msg:2: "));
}

TEST_F(IdlFileTest, AFileThatIncludesItselfIsReadOnce)
{
    const IdlFile file = IdlFile::Load(Write("a.idl", "#include \"a.idl\"\n@final struct B { long x; };\n"));
    EXPECT_THAT(file.Reason, IsEmpty());
    EXPECT_THAT(file.Messages, SizeIs(1));
}

}  // namespace
}  // namespace Rabit
