#include <rabit/mcap/FileSink.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace Rabit::Mcap
{
namespace
{

// Syncs the folder, so that the name of a new file survives a power loss, too.
void SyncFolder(const std::string &folder)
{
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0)
    {
        static_cast<void>(::fsync(descriptor));
        ::close(descriptor);
    }
}

// Returns the descriptor of a new file.
int MakeFile(const std::string &path)
{
    const std::string parent = std::filesystem::path(path).parent_path().string();
    const std::string folder = parent.empty() ? "." : parent;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
    {
        throw std::runtime_error("the folder " + folder + " cannot be made: " + error.message());
    }
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640);
    if (descriptor < 0)
    {
        throw std::runtime_error(path + ": " + std::generic_category().message(errno));
    }
    SyncFolder(folder);
    return descriptor;
}

}  // namespace

FileSink::FileSink(const std::string &path) : _descriptor(MakeFile(path)) {}

FileSink::~FileSink()
{
    ::close(_descriptor);
}

bool FileSink::Write(ByteView bytes)
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

bool FileSink::Sync()
{
    return ::fdatasync(_descriptor) == 0;
}

}  // namespace Rabit::Mcap
