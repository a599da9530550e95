// Definitions of px4_msgs, ardupilot_msgs and the common interfaces, each made into a message: the table in
// idl/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "RunIdlc.h"

namespace
{

namespace fs = std::filesystem;

struct Definition
{
    std::string Package;
    fs::path File;
    std::string Idl() const { return Package + "/msg/" + File.stem().string() + ".idl"; }
};

std::vector<Definition> Definitions()
{
    std::vector<Definition> all;
    for (const char *root : {Paths::RosPackages, Paths::Px4Messages})
    {
        for (const auto &entry : fs::recursive_directory_iterator(root))
        {
            const std::string folder = entry.path().parent_path().parent_path().filename().string();
            if (entry.path().extension() == ".msg" || entry.path().extension() == ".idl")
            {
                all.push_back({folder == "made_by_rosidl" ? "made" : folder, entry.path()});
            }
        }
    }
    std::sort(all.begin(), all.end(),
              [](const Definition &a, const Definition &b) { return a.File < b.File; });
    return all;
}

int Shell(const std::string &command)
{
    return std::system(command.c_str());
}

TEST(RosPackages, AreAllAccepted)
{
    const ScratchDirectory scratch;
    const std::string idl = (scratch.Path() / "idl").string();
    const std::string log = (scratch.Path() / "log").string();
    const std::vector<Definition> all = Definitions();
    ASSERT_GT(all.size(), 40U);
    for (const Definition &definition : all)
    {
        ASSERT_EQ(
            Shell(std::string("'") + Paths::RosIdl + "' " + definition.Package + " '" +
                  definition.File.string() + "' '" + idl + "/" + definition.Idl() + "' 2>'" + log + "'"),
            0)
            << ReadFile(log);
    }
    for (const Definition &definition : all)
    {
        EXPECT_EQ(
            Shell(std::string("'") + Paths::Idlc + "' -f case-sensitive -W no-implicit-extensibility -b '" +
                  idl + "' -I '" + idl + "' -l '" + Paths::Plugin + "' -o '" + idl + "/out' '" + idl + "/" +
                  definition.Idl() + "' 2>'" + log + "'"),
            0)
            << definition.Idl();
        EXPECT_EQ(ReadFile(log), "") << definition.Idl();
    }
}

TEST(RosPackages, AByteOrderMarkAtTheBeginningOfAFileIsNoPartOfTheText)
{
    const ScratchDirectory scratch;
    const auto path = [&scratch](const char *name) { return "'" + (scratch.Path() / name).string() + "'"; };
    EXPECT_EQ(Shell("printf '\\357\\273\\277int32 sec\\n' > " + path("Thing.msg")), 0);
    EXPECT_EQ(Shell(std::string("'") + Paths::RosIdl + "' pkg " + path("Thing.msg") + " " +
                    path("Thing.idl") + " 2>" + path("log")),
              0)
        << ReadFile(scratch.Path() / "log");
    EXPECT_NE(ReadFile(scratch.Path() / "Thing.idl").find("    int32 sec;"), std::string::npos);
}

TEST(RosPackages, LeaveNoFileOfWhatIsRefused)
{
    const ScratchDirectory scratch;
    const fs::path msg = scratch.Path() / "Thing.msg";
    EXPECT_EQ(Shell("printf 'wstring a\\n' > '" + msg.string() + "'"), 0);
    const fs::path out = scratch.Path() / "Thing.idl";
    EXPECT_NE(Shell(std::string("'") + Paths::RosIdl + "' pkg '" + msg.string() + "' '" + out.string() +
                    "' 2>'" + (scratch.Path() / "log").string() + "'"),
              0);
    EXPECT_FALSE(fs::exists(out));
    EXPECT_NE(ReadFile(scratch.Path() / "log").find("Thing.msg:1: type wstring is not supported"),
              std::string::npos);
}

}  // namespace
