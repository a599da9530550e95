// The table of keys, from which the manual's reference is made, says what the loader does.
#include <gtest/gtest.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/gateway/NodeParameters.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "configuration/ConfigSections.h"

namespace Rabit
{
namespace
{

// For each section: files around one key, with all else that the section needs. `@` is where the key goes.
const std::map<std::string, std::vector<std::string>> Frames = {
    {"", {"node: a\n@\n", "@\n", "node: uav1\n@\n"}},
    {"agreement", {"node: uav1\nagreement: {members: [uav1], @}\n", "node: uav1\nagreement: {@}\n"}},
    {"publish",
     {"node: a\npublish:\n  - {message: M, type: T, @}\n", "node: a\npublish:\n  - {type: T, @}\n",
      "node: a\npublish:\n  - {message: M, @}\n"}},
    {"subscribe",
     {"node: a\nsubscribe:\n  - {message: M, type: T, @}\n", "node: a\nsubscribe:\n  - {type: T, @}\n",
      "node: a\nsubscribe:\n  - {message: M, @}\n"}},
    {"accept",
     {"node: a\naccept:\n  - {queue: Q, types: [T], @}\n", "node: a\naccept:\n  - {types: [T], @}\n",
      "node: a\naccept:\n  - {queue: Q, @}\n"}},
    {"send", {"node: a\nsend:\n  - {@}\n"}},
    {"security", {"node: a\nsecurity: {@}\n"}},
    {"radio", {"node: a\nradio: {@}\n"}},
    {"record",
     {"node: a\nsubscribe:\n  - {message: Pose, type: T}\nrecord: {folder: f, @}\n",
      "node: a\nrecord: {@}\n"}},
    {"paths", {"node: a\npaths:\n  - {name: p, @}\n", "node: a\npaths:\n  - {@}\n"}},
    {"fetch", {"node: a\nfetch: {folder: f, @}\n", "node: a\nfetch: {from: [b], @}\n"}},
    {"record.black_box", {"node: a\nrecord: {folder: f, black_box: {@}}\n"}},
    {"foreign",
     {"node: a\nforeign:\n  - {subscribe: S, as: A, type: T, @}\n",
      "node: a\nforeign:\n  - {publish: P, type: T, @}\n", "node: a\nforeign:\n  - {as: A, type: T, @}\n",
      "node: a\nforeign:\n  - {subscribe: S, type: T, @}\n", "node: a\nforeign:\n  - {type: T, @}\n",
      "node: a\nforeign:\n  - {publish: P, @}\n",
      "node: a\nforeign:\n  - {subscribe: S, as: A, type: T, each: queue, @}\n"}},
    {"foxglove",
     {"node: a\nfoxglove:\n  - {as: foxglove.Log, fields: {message: m}, @}\n",
      "node: a\nfoxglove:\n  - {message: M, fields: {latitude: a, longitude: b}, @}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.LocationFix, @}\n"}},
    {"foxglove.LocationFix",
     {"node: a\nfoxglove:\n  - {message: M, as: foxglove.LocationFix, fields: {latitude: a, longitude: b, "
      "@}}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.LocationFix, fields: {longitude: b, @}}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.LocationFix, fields: {latitude: a, @}}\n"}},
    {"foxglove.CompressedImage",
     {"node: a\nfoxglove:\n  - {message: M, as: foxglove.CompressedImage, fields: {data: a, format: b, @}}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.CompressedImage, fields: {format: b, @}}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.CompressedImage, fields: {data: a, @}}\n"}},
    {"foxglove.Log",
     {"node: a\nfoxglove:\n  - {message: M, as: foxglove.Log, fields: {message: a, @}}\n",
      "node: a\nfoxglove:\n  - {message: M, as: foxglove.Log, fields: {@}}\n"}}};

class ConfigSectionsTest : public ::testing::Test
{
protected:
    ~ConfigSectionsTest() override
    {
        std::error_code ignored;
        std::filesystem::remove(_file, ignored);
    }

    // Empty if the loader accepts the text.
    std::string ErrorOf(const std::string &yaml) const
    {
        std::ofstream(_file) << yaml;
        try
        {
            LoadGatewayConfig(_file, "", [](const std::string &) { return std::string(); });
            return "";
        }
        catch (const ConfigError &error)
        {
            return error.what();
        }
    }

    // The errors of all frames of the section with that key and value; empty if one frame is accepted.
    std::string ErrorsOf(const std::string &path, const std::string &key, const std::string &value) const
    {
        std::string errors;
        for (std::string frame : Frames.at(path))
        {
            frame.replace(frame.find('@'), 1, key + ": " + value);
            const std::string error = ErrorOf(frame);
            if (error.empty())
            {
                return "";
            }
            errors += error + '\n';
        }
        return errors;
    }

    const std::string _file = ::testing::TempDir() + "rabit-sections-" + std::to_string(::getpid()) + ".yaml";
};

TEST_F(ConfigSectionsTest, EveryExampleIsAccepted)
{
    for (const ConfigSection &section : ConfigSections())
    {
        for (const ConfigKey &key : section.Keys)
        {
            EXPECT_EQ(ErrorsOf(section.Path, key.Name, key.Example), "") << section.Path << '.' << key.Name;
        }
    }
}

TEST_F(ConfigSectionsTest, EveryDefaultIsAccepted)
{
    for (const ConfigSection &section : ConfigSections())
    {
        for (const ConfigKey &key : section.Keys)
        {
            if (!key.Default.empty())
            {
                EXPECT_EQ(ErrorsOf(section.Path, key.Name, key.Default), "")
                    << section.Path << '.' << key.Name;
            }
        }
    }
}

// A key that stands in the table and is never read would be accepted with any value.
TEST_F(ConfigSectionsTest, EveryKeyIsRead)
{
    for (const ConfigSection &section : ConfigSections())
    {
        for (const ConfigKey &key : section.Keys)
        {
            const bool takesAnything = section.Path.empty() && key.Name == "parameters";
            if (!takesAnything)
            {
                EXPECT_NE(ErrorsOf(section.Path, key.Name, "{no: [such, {value: there}]}"), "")
                    << section.Path << '.' << key.Name;
            }
        }
    }
}

TEST_F(ConfigSectionsTest, EveryKeyIsExplained)
{
    for (const ConfigSection &section : ConfigSections())
    {
        EXPECT_NE(section.Help, "") << section.Path;
        for (const ConfigKey &key : section.Keys)
        {
            EXPECT_NE(key.Value, "") << section.Path << '.' << key.Name;
            EXPECT_NE(key.Example, "") << section.Path << '.' << key.Name;
        }
    }
}

}  // namespace
}  // namespace Rabit
