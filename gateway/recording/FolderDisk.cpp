#include "recording/FolderDisk.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace Rabit
{
namespace
{

class PosixFile final : public RecordingDisk::File
{
public:
    explicit PosixFile(int descriptor) : _descriptor(descriptor) {}
    ~PosixFile() override { ::close(_descriptor); }

    bool Write(Mcap::ByteView bytes) override
    {
        while (!bytes.empty())
        {
            const ssize_t written = ::write(_descriptor, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR)
            {
                continue;
            }
            if (written <= 0)
            {
                return false;
            }
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        return true;
    }

    bool Sync() override { return ::fdatasync(_descriptor) == 0; }

private:
    const int _descriptor;
};

}  // namespace

FolderDisk::FolderDisk(std::string folder) : _folder(std::move(folder)) {}

std::unique_ptr<RecordingDisk::File> FolderDisk::Create(const std::string &name, std::string &reason)
{
    std::error_code error;
    std::filesystem::create_directories(_folder, error);
    if (error)
    {
        reason = "the folder " + _folder + " cannot be made: " + error.message();
        return nullptr;
    }
    const std::string path = _folder + "/" + name;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640);
    if (descriptor < 0)
    {
        reason = path + ": " + std::generic_category().message(errno);
        return nullptr;
    }
    SyncFolder();
    return std::make_unique<PosixFile>(descriptor);
}

// Syncs the folder, so that the name of a new file survives a power loss, too.
void FolderDisk::SyncFolder() const
{
    const int descriptor = ::open(_folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0)
    {
        static_cast<void>(::fsync(descriptor));
        ::close(descriptor);
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
