// Converts a file of a ROS 2 message package to IDL that idlc and the generator accept.
//
//     rabit_ros_idl PACKAGE FILE.msg|FILE.idl OUTPUT.idl
#include "model/Names.h"
#include "model/Refusals.h"
#include "ros/MsgReader.h"
#include "ros/MsgToIdl.h"
#include "ros/RosIdlText.h"

#include <rabit/base/WithoutByteOrderMark.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace
{

namespace fs = std::filesystem;

std::string ReadFile(const fs::path &path)
{
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad())
    {
        throw std::runtime_error(path.string() + ": cannot be read");
    }
    return std::string(Rabit::WithoutByteOrderMark(text));
}

// Writes the whole file or nothing.
void WriteFile(const fs::path &path, const std::string &text)
{
    fs::path partial = path;
    partial += ".part";
    if (path.has_parent_path())
    {
        fs::create_directories(path.parent_path());
    }
    {
        std::ofstream file(partial, std::ios::binary | std::ios::trunc);
        file << text;
        file.close();
        if (!file)
        {
            throw std::runtime_error("cannot write " + partial.string());
        }
    }
    fs::rename(partial, path);
}

std::optional<std::string> FromMsg(const fs::path &input, const std::string &package)
{
    RabitIdl::Refusals refusals;
    const std::string name = input.stem().string();
    for (const std::string &word : {package, name})
    {
        const std::string reason = RabitIdl::WhyNotCpp(word);
        if (!reason.empty())
        {
            refusals.Add(input.string(), 1, "'" + word + "' " + reason);
        }
    }
    const RabitIdl::MsgFile file =
        RabitIdl::MsgReader(input.string(), refusals).Read(ReadFile(input), package, name);
    if (!refusals.Empty())
    {
        refusals.Print();
        return std::nullopt;
    }
    return RabitIdl::MsgToIdl(file);
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc != 4)
    {
        std::fprintf(stderr, "usage: rabit_ros_idl PACKAGE FILE.msg|FILE.idl OUTPUT.idl\n");
        return 2;
    }
    try
    {
        const fs::path input = argv[2];
        const auto text = input.extension() == ".msg" ? FromMsg(input, argv[1])
                                                      : std::optional(RabitIdl::RosIdlText(ReadFile(input)));
        if (text)
        {
            // IDL files of ROS 2 have no include guards, as rosidl does not read includes.
            const std::string guard = std::string("RABIT_IDL_") + argv[1] + "_" + input.stem().string();
            WriteFile(argv[3], "#ifndef " + guard + "\n#define " + guard + "\n" + *text + "#endif\n");
        }
        return text ? 0 : 1;
    }
    catch (const std::exception &error)
    {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
