// A name that is a macro in generated code would end in an error of the compiler that nobody understands.
#include "RunIdlc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace
{

namespace fs = std::filesystem;

// The macros that the compiler sees behind the includes of a generated header and source.
std::set<std::string> MacrosOfGeneratedCode(const fs::path &folder)
{
    std::ofstream(folder / "all.cpp") << "#include \"conveniences.idl.h\"\n"
                                         "#include <rabit/idl/GeneratedMessageType.h>\n"
                                         "#include <rabit/idl/MessageTypeRegistry.h>\n"
                                         "#include <rabit/idl/Shapes.h>\n"
                                         "#include <stdexcept>\n"
                                         "#include <type_traits>\n"
                                         "#include <typeinfo>\n";
    const fs::path list = folder / "macros.txt";
    const std::string command = std::string("'") + Paths::Compiler + "' -std=gnu++20 " +
                                Paths::IncludeOptions + " -dM -E '" + (folder / "all.cpp").string() + "' >'" +
                                list.string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::set<std::string> names;
    std::ifstream file(list);
    for (std::string line; std::getline(file, line);)
    {
        const std::string rest = line.substr(std::string("#define ").size());
        names.insert(rest.substr(0, rest.find_first_of(" (")));
    }
    return names;
}

constexpr const char *Families[] = {"BOOST_", "CLONE_", "FASTCDR_", "PTHREAD_", "SCHED_"};

// Those that IDL files cannot have for another reason; and `linux` and `unix`, which generated headers undo.
bool IsRefusedAnyhow(const std::string &name)
{
    const bool isOfFamily = std::any_of(std::begin(Families), std::end(Families),
                                        [&name](const char *prefix) { return name.starts_with(prefix); }) ||
                            (name.size() > 4 && name.starts_with("SYS_") &&
                             std::islower(static_cast<unsigned char>(name[4])) != 0);
    return name[0] == '_' || name.find("__") != std::string::npos || isOfFamily || name == "linux" ||
           name == "unix";
}

TEST(Macros, NoNameOfAnIdlFileMayBeOneThatGeneratedCodeSees)
{
    if (__GNUC__ != 12)
    {
        GTEST_SKIP() << "the table of macros is that of g++ 12, as in Debian 12";
    }
    const ScratchDirectory scratch;
    std::set<std::string> names = MacrosOfGeneratedCode(scratch.Path());
    std::erase_if(names, IsRefusedAnyhow);
    ASSERT_GT(names.size(), 500U);
    const fs::path idl = scratch.Path() / "names.idl";
    std::ofstream file(idl);
    int number = 0;
    for (const std::string &name : names)
    {
        file << "module M" << number++ << " { enum E { " << name << " }; };\n";
    }
    file.close();
    const IdlcResult result = RunIdlc(idl, scratch.Path());
    for (const std::string &name : names)
    {
        EXPECT_NE(result.Errors.find("'" + name + "' is a "), std::string::npos)
            << name << ": add it to idl/model/LibraryNames.cpp";
    }
}

}  // namespace
