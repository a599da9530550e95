#include "dynamic/IdlIncludes.h"

#include "dynamic/ShapeBuilder.h"
#include "model/Names.h"
#include "model/Refusals.h"
#include "ros/MsgReader.h"
#include "ros/MsgToIdl.h"

#include <rabit/base/WithoutByteOrderMark.h>

#include <filesystem>
#include <fstream>
#include <istream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace Rabit::Dynamic
{
namespace
{

constexpr std::size_t DeepestInclude = 32;

// Returns the IDL of a message of ROS 2, which is in PACKAGE/msg/NAME.msg.
std::string IdlOfMsg(const std::filesystem::path &path, std::istream &file)
{
    const std::string package =
        std::filesystem::absolute(path).parent_path().parent_path().filename().string();
    const std::string name = path.stem().string();
    for (const std::string &word : {package, name})
    {
        if (const std::string reason = RabitIdl::WhyNotCpp(word); !reason.empty())
        {
            throw Refused(path.string() + ":1: '" + word + "' " + reason);
        }
    }
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    RabitIdl::Refusals refusals;
    const RabitIdl::MsgFile message = RabitIdl::MsgReader(path.string(), refusals)
                                          .Read(std::string(WithoutByteOrderMark(text)), package, name);
    if (!refusals.Empty())
    {
        throw Refused(refusals.First());
    }
    return RabitIdl::MsgToIdl(message);
}

class Includer
{
public:
    explicit Includer(const std::vector<std::string> &folders) : _folders(folders) {}

    void Add(const std::filesystem::path &path, const std::string &from, std::size_t depth)
    {
        std::ifstream file(path, std::ios::binary);
        if (!file || std::filesystem::is_directory(path))
        {
            throw Refused(from + path.string() + ": cannot be read");
        }
        if (depth > DeepestInclude)
        {
            throw Refused(from + "the files include each other");
        }
        std::error_code error;
        _seen.insert(std::filesystem::canonical(path, error));
        if (path.extension() == ".msg")
        {
            std::istringstream idl(IdlOfMsg(path, file));
            AddLines(path, idl, depth);
            return;
        }
        Paths.push_back(path.string());
        AddLines(path, file, depth);
    }

    std::ostringstream Text;
    std::vector<std::string> Paths;

private:
    void AddLines(const std::filesystem::path &path, std::istream &lines, std::size_t depth)
    {
        const std::string name = path.string();
        Mark(1, name);
        std::string line;
        for (std::size_t number = 1; std::getline(lines, line); ++number)
        {
            if (number == 1)
            {
                line = std::string(WithoutByteOrderMark(line));
            }
            const std::string place = name + ":" + std::to_string(number) + ": ";
            const std::size_t first = line.find_first_not_of(" \t");
            if (first == std::string::npos || line[first] != '#')
            {
                Text << line << '\n';
                continue;
            }
            std::smatch match;
            static const std::regex include(R"(\s*#\s*include\s*["<]([^">]+)[">].*)");
            static const std::regex guard(
                R"(\s*#\s*(ifndef\s+\w+|define\s+\w+|endif|pragma\s+once)\s*(//.*|/\*.*)?\r?)");
            if (std::regex_match(line, match, include))
            {
                Include(path, match[1], place, depth);
                Mark(number + 1, name);
            }
            else if (std::regex_match(line, guard))
            {
                Text << '\n';
            }
            else
            {
                throw Refused(place + "`" + line.substr(first) +
                              "` is not supported here; of the preprocessor only #include, #pragma once and "
                              "an #ifndef around the file are");
            }
        }
    }

    void Mark(std::size_t line, const std::string &file)
    {
        Text << "#line " << std::to_string(line) << " \"" << file << "\"\n";
    }

    void Include(const std::filesystem::path &includer, const std::string &name, const std::string &place,
                 std::size_t depth)
    {
        std::vector<std::filesystem::path> folders{includer.parent_path()};
        folders.insert(folders.end(), _folders.begin(), _folders.end());
        // Packages of ROS 2 lie beside each other.
        const std::filesystem::path own = std::filesystem::absolute(includer).parent_path();
        const bool isRos = own.filename() == "msg";
        if (isRos)
        {
            folders.push_back(own.parent_path().parent_path());
        }
        std::vector<std::filesystem::path> places;
        for (const std::filesystem::path &folder : folders)
        {
            if (isRos)
            {
                places.push_back((folder / name).replace_extension(".msg"));
            }
            places.push_back(folder / name);
        }
        for (const std::filesystem::path &path : places)
        {
            std::error_code error;
            const auto whole = std::filesystem::canonical(path, error);
            if (error)
            {
                continue;
            }
            if (_seen.count(whole) == 0)
            {
                Add(path, place, depth + 1);
            }
            return;
        }
        throw Refused(place + "there is no file `" + name + "`");
    }

    const std::vector<std::string> &_folders;
    std::set<std::filesystem::path> _seen;
};

}  // namespace

IncludedText WithIncludes(const std::string &path, const std::vector<std::string> &folders)
{
    Includer includer(folders);
    includer.Add(path, "", 0);
    return {includer.Text.str(), includer.Paths};
}

}  // namespace Rabit::Dynamic
