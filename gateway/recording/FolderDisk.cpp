#include "recording/FolderDisk.h"

#include <rabit/mcap/FileSink.h>

#include <sys/statvfs.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace Rabit
{
namespace
{

class DiskFile final : public RecordingDisk::File
{
public:
    explicit DiskFile(const std::string &path) : _sink(path) {}

    bool Write(Mcap::ByteView bytes) override { return _sink.Write(bytes); }
    bool Sync() override { return _sink.Sync(); }

private:
    Mcap::FileSink _sink;
};

}  // namespace

FolderDisk::FolderDisk(std::string folder) : _folder(std::move(folder)) {}

std::unique_ptr<RecordingDisk::File> FolderDisk::Create(const std::string &name, std::string &reason)
{
    try
    {
        return std::make_unique<DiskFile>(_folder + "/" + name);
    }
    catch (const std::runtime_error &error)
    {
        reason = error.what();
        return nullptr;
    }
}

std::vector<RecordingDisk::Entry> FolderDisk::List()
{
    std::vector<Entry> entries;
    std::error_code error;
    for (std::filesystem::directory_iterator at(_folder, error), end; !error && at != end;
         at.increment(error))
    {
        std::error_code none;
        if (at->is_regular_file(none))
        {
            const std::uintmax_t size = at->file_size(none);
            entries.push_back({at->path().filename().string(), none ? 0 : size});
        }
    }
    return entries;
}

bool FolderDisk::Remove(const std::string &name)
{
    return ::unlink((_folder + "/" + name).c_str()) == 0;
}

std::optional<std::uint64_t> FolderDisk::FreeBytes()
{
    struct statvfs status
    {
    };
    if (::statvfs(_folder.c_str(), &status) != 0)
    {
        return std::nullopt;
    }
    return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

}  // namespace Rabit
