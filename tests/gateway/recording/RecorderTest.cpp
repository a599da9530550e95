#include "recording/Recorder.h"

#include <gtest/gtest.h>
#include <rabit/RabitLog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "FakeDisk.h"
#include "recording/FolderDisk.h"

namespace Rabit
{
namespace
{

RecordingSettings SettingsOf(const std::string &folder)
{
    RecordingSettings settings;
    settings.Name = "uav1";
    settings.Record.Folder = folder;
    settings.Record.Free = 0;
    settings.Record.Memory = 1U << 20;
    return settings;
}

// The threads that record go on while the disk does not.
TEST(Recorder, WaitsForTheDiskAlone)
{
    auto disk = std::make_unique<FakeDisk>();
    FakeDisk &files = *disk;
    std::promise<void> release;
    const std::shared_future<void> released = release.get_future().share();
    files.BeforeWrite = [released] { released.wait(); };
    constexpr std::uint64_t count = 100000;
    std::uint64_t kept = 0;
    RecordingStatus status;
    std::map<std::string, std::shared_ptr<FakeDisk::Content>> written;
    {
        Recorder recorder(std::move(disk), SettingsOf("x"), [] { return std::uint64_t{1000}; });
        const std::uint32_t stream = recorder.Inbox().AddStream({.Topic = "a", .SchemaName = ""});
        for (std::uint64_t at = 0; at < count; ++at)
        {
            kept += recorder.Inbox().Put({stream, 0, at, at, Mcap::Bytes(100)}) ? 1 : 0;
        }
        EXPECT_LT(kept, count);
        release.set_value();
        recorder.Inbox().Close();
        while (recorder.Status().Messages < kept)
        {
            std::this_thread::yield();
        }
        status = recorder.Status();
        written = files.Files;
    }
    EXPECT_EQ(status.Messages, kept);
    ASSERT_EQ(written.size(), 1U);
    const MemoryFile file(written.begin()->second->Bytes);
    EXPECT_EQ(LogTimesOf(file).size(), kept);
    EXPECT_EQ(MetadataOf(file, "rabit.losses").at("a"), std::to_string(count - kept));
}

TEST(Recorder, LeavesAWholeFileInAFolderThatItMakes)
{
    const auto folder =
        std::filesystem::path(testing::TempDir()) / ("rabit_recorder_" + std::to_string(::getpid()));
    {
        Recorder recorder(std::make_unique<FolderDisk>(folder / "deep"), SettingsOf(folder),
                          [] { return std::uint64_t{1000}; });
        const std::uint32_t stream = recorder.Inbox().AddStream({.Topic = "a", .SchemaName = ""});
        EXPECT_TRUE(recorder.Inbox().Put({stream, 0, 5, 5, Mcap::Bytes(100)}));
    }
    const auto path = folder / "deep" / "uav1_000001_19700101T000000Z.mcap";
    std::ifstream stream(path, std::ios::binary);
    const MemoryFile file(Mcap::Bytes(std::istreambuf_iterator<char>(stream), {}));
    EXPECT_EQ(LogTimesOf(file), std::vector<std::uint64_t>{5});
    FolderDisk disk(folder / "deep");
    ASSERT_EQ(disk.List().size(), 1U);
    EXPECT_EQ(disk.List()[0].Bytes, file.Content.size());
    EXPECT_GT(*disk.FreeBytes(), 0U);
    std::string reason;
    EXPECT_EQ(disk.Create(disk.List()[0].Name, reason), nullptr);
    EXPECT_EQ(reason, path.string() + ": File exists");
    EXPECT_TRUE(disk.Remove(disk.List()[0].Name));
    EXPECT_TRUE(disk.List().empty());
    std::filesystem::remove_all(folder);
}

TEST(Recorder, NamesEachRemovedFileInTheLog)
{
    auto disk = std::make_unique<FakeDisk>();
    const std::string earlier = "uav1_000001_20250101T000000Z.mcap";
    disk->Put(earlier, 2U << 20);
    RecordingSettings settings = SettingsOf("/recordings");
    settings.Record.Keep = 1U << 20;
    std::vector<std::string> lines;  // written by the recorder's thread, which has ended when they are read
    const auto listener =
        RabitLog::Listen([&](RabitLogLevel, const std::string &line) { lines.push_back(line); });
    {
        Recorder recorder(std::move(disk), settings, [] { return std::uint64_t{1000}; });
        const std::uint32_t stream = recorder.Inbox().AddStream({.Topic = "a", .SchemaName = ""});
        EXPECT_TRUE(recorder.Inbox().Put({stream, 0, 5, 5, Mcap::Bytes(100)}));
    }
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].rfind("recording: removed /recordings/" + earlier, 0), 0U) << lines[0];
}

// With keys, too, the messages in a recording are not encrypted.
TEST(FolderDisk, MakesFilesThatOtherUsersCannotRead)
{
    const auto folder =
        std::filesystem::path(testing::TempDir()) / ("rabit_folder_disk_" + std::to_string(::getpid()));
    const mode_t mask = ::umask(0);
    std::string reason;
    const bool isMade = FolderDisk(folder).Create("a.mcap", reason) != nullptr;
    ::umask(mask);
    ASSERT_TRUE(isMade) << reason;
    using std::filesystem::perms;
    EXPECT_EQ(std::filesystem::status(folder / "a.mcap").permissions(),
              perms::owner_read | perms::owner_write | perms::group_read);
    std::filesystem::remove_all(folder);
}

// A folder below a file cannot be made by any user.
TEST(FolderDisk, NamesAFolderThatItCannotMakeWithTheReason)
{
    const auto file =
        std::filesystem::path(testing::TempDir()) / ("rabit_folder_file_" + std::to_string(::getpid()));
    std::ofstream(file) << "x";
    const std::string folder = (file / "deep").string();
    std::string reason;
    EXPECT_EQ(FolderDisk(folder).Create("a.mcap", reason), nullptr);
    EXPECT_EQ(reason, "the folder " + folder + " cannot be made: Not a directory");
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace Rabit
