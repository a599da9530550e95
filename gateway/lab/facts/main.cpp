// lab_facts FOLDER: follows all recordings in and below a folder, and writes what they hold as JSON, one
// object a line (FlightFile.h). After each round of reading it writes {"fact": "read"}. It ends at the end of
// its standard input, after a last round.
#include <CLI/CLI.hpp>

#include <poll.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "FlightFile.h"

namespace
{

constexpr int LookEachMs = 200;

using Files = std::map<std::string, std::unique_ptr<Rabit::Facts::FlightFile>>;

void FindFiles(const std::string &folder, const std::set<std::string> &fields, Files &files)
{
    std::error_code failed;
    std::filesystem::recursive_directory_iterator entry(
        folder, std::filesystem::directory_options::skip_permission_denied, failed);
    for (; !failed && entry != std::filesystem::recursive_directory_iterator(); entry.increment(failed))
    {
        const std::string path = entry->path().string();
        if (entry->path().extension() == ".mcap" && !files.contains(path))
        {
            files[path] = std::make_unique<Rabit::Facts::FlightFile>(path, fields);
        }
    }
}

// True at the end of the standard input.
bool WaitForEnd()
{
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, LookEachMs) <= 0)
    {
        return false;
    }
    std::array<char, 256> ignored{};
    return read(STDIN_FILENO, ignored.data(), ignored.size()) <= 0;
}

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("Tells what nodes record, while they record it.");
    std::string folder;
    std::vector<std::string> fields;
    app.add_option("FOLDER", folder, "All recordings in and below it")->required();
    app.add_option("--fields", fields, "A message whose values are told; may be repeated")
        ->allow_extra_args(false);
    CLI11_PARSE(app, argc, argv);
    const std::set<std::string> wanted(fields.begin(), fields.end());
    Files files;
    for (bool isLast = false; !isLast;)
    {
        isLast = WaitForEnd();
        FindFiles(folder, wanted, files);
        for (const auto &[path, file] : files)
        {
            file->Follow(
                [](nlohmann::ordered_json fact)
                { std::cout << fact.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) << '\n'; });
        }
        std::cout << "{\"fact\":\"read\"}" << std::endl;
        if (!std::cout)
        {
            return 1;
        }
    }
    return 0;
}
