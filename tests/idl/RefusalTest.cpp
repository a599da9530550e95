// Each file in refused/ breaks one rule. The file beside it has the generator's message, word for word.
#include "RunIdlc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace
{

namespace fs = std::filesystem;

std::vector<std::string> RefusedFiles()
{
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(Paths::Refused))
    {
        if (entry.path().extension() == ".idl")
        {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

class RefusalTest : public testing::TestWithParam<std::string>
{
};

// The expectation names files without their directory.
std::string WithoutDirectory(std::string text)
{
    const std::string directory = std::string(Paths::Refused) + "/";
    for (std::size_t at = text.find(directory); at != std::string::npos; at = text.find(directory, at))
    {
        text.erase(at, directory.size());
    }
    return text;
}

TEST_P(RefusalTest, SaysWhereAndWhy)
{
    const fs::path file = fs::path(Paths::Refused) / (GetParam() + ".idl");
    const ScratchDirectory scratch;
    const IdlcResult result = RunIdlc(file, scratch.Path());
    fs::path expectation = file;
    expectation.replace_extension(".txt");
    EXPECT_EQ(WithoutDirectory(result.Errors), ReadFile(expectation));
    EXPECT_NE(result.ExitCode, 0);
}

TEST_P(RefusalTest, LeavesNoOutput)
{
    const ScratchDirectory scratch;
    RunIdlc(fs::path(Paths::Refused) / (GetParam() + ".idl"), scratch.Path());
    for (const auto &entry : fs::directory_iterator(scratch.Path()))
    {
        EXPECT_EQ(entry.path().filename(), "errors.log");
    }
}

INSTANTIATE_TEST_SUITE_P(Files, RefusalTest, testing::ValuesIn(RefusedFiles()),
                         [](const auto &item) { return item.param; });

}  // namespace
