#include "dynamic/IdlIncludes.h"

#include "dynamic/ShapeBuilder.h"

#include <rabit/base/WithoutByteOrderMark.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace Rabit::Dynamic
{
namespace
{

constexpr std::size_t DeepestInclude = 32;

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
        const std::string name = path.string();
        Paths.push_back(name);
        Mark(1, name);
        std::string line;
        for (std::size_t number = 1; std::getline(file, line); ++number)
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

    std::ostringstream Text;
    std::vector<std::string> Paths;

private:
    void Mark(std::size_t line, const std::string &file)
    {
        Text << "#line " << std::to_string(line) << " \"" << file << "\"\n";
    }

    void Include(const std::filesystem::path &includer, const std::string &name, const std::string &place,
                 std::size_t depth)
    {
        std::vector<std::filesystem::path> places{includer.parent_path() / name};
        for (const std::string &folder : _folders)
        {
            places.push_back(std::filesystem::path(folder) / name);
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
