// A fleet with an authority in a folder of the test's own.
#pragma once

#include <gtest/gtest.h>
#include <rabit/keys/KeysError.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "keys/FleetAuthority.h"
#include "keys/KeyFiles.h"
#include "keys/MemberFolder.h"
#include "keys/MemberPermissions.h"

namespace Rabit::Keys
{

class FleetFolder : public testing::Test
{
protected:
    static constexpr std::time_t ADay = 24 * 60 * 60;
    static constexpr std::time_t Now = 1795435200;  // 2026-11-23, noon

    FleetFolder()
        : Root(testing::TempDir() + "rabit-fleet-" + std::to_string(::getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name())
    {
        std::filesystem::remove_all(Root);
        std::filesystem::create_directories(Root);
        FleetAuthority::Init(Place());
    }
    ~FleetFolder() override { std::filesystem::remove_all(Root); }

    std::string Place() const { return Root + "/keys"; }
    std::string FolderOf(const std::string &node) const { return Place() + "/" + node; }

    static Access Needs() { return {.Publish = {"rabit/Link", "Pose"}, .Subscribe = {"rabit/Link", "Pose"}}; }
    static FleetAuthority::Request RequestFor(const std::string &node)
    {
        return {.Node = node, .Allowed = PermissionsFor(Needs())};
    }
    // Makes the folder look like one of the former format.
    static void MakeFormer(const std::string &folder, const std::string &file)
    {
        std::filesystem::create_directories(std::filesystem::path(folder + "/" + file).parent_path());
        Overwrite(folder + "/" + file, "X.509");
    }
    static FleetAuthority::Period Year() { return {.Now = Now, .Days = 365}; }
    void Add(const std::string &node) const { FleetAuthority(Place()).Add(RequestFor(node), Year()); }
    void Renew(const std::string &node, const MemberRequest *signing = nullptr) const
    {
        const FleetAuthority fleet(Place());
        fleet.Renew(fleet.RequestOf(node), Year(), signing);
    }
    std::size_t Revoke(const std::string &node) const { return FleetAuthority(Place()).Revoke(node, Now); }

    // Copies the node's folder, as it is now, to where the node has it.
    std::string CopyOf(const std::string &node) const
    {
        const std::string folder = Root + "/on_" + node;
        std::filesystem::create_directories(folder);
        std::filesystem::copy(
            FolderOf(node), folder,
            std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
        return folder;
    }
    static void Overwrite(const std::string &file, const std::string &text)
    {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
    }

    // Returns the error that the work throws; empty if it throws none.
    template <typename Work>
    static std::string WhyNot(const Work &work)
    {
        try
        {
            work();
            return "";
        }
        catch (const KeysError &error)
        {
            return error.what();
        }
    }
    static std::string WhyNoMember(const std::string &folder)
    {
        return WhyNot([&] { const MemberFolder member(folder); });
    }

    const std::string Root;
};

}  // namespace Rabit::Keys
