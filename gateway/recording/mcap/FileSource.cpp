#include <rabit/mcap/FileSource.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace Rabit::Mcap
{

FileSource::FileSource(const std::string &path) : _descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC))
{
    struct stat status
    {
    };
    if (_descriptor < 0 || ::fstat(_descriptor, &status) != 0)
    {
        const std::string reason = std::generic_category().message(errno);
        if (_descriptor >= 0)
        {
            ::close(_descriptor);
        }
        throw std::runtime_error(path + ": " + reason);
    }
    if (!S_ISREG(status.st_mode))
    {
        ::close(_descriptor);
        throw std::runtime_error(path + ": it is no file");
    }
    _size = static_cast<std::uint64_t>(status.st_size);
}

FileSource::~FileSource()
{
    ::close(_descriptor);
}

bool FileSource::Read(std::uint64_t offset, std::span<std::uint8_t> to)
{
    while (!to.empty())
    {
        const ssize_t size = ::pread(_descriptor, to.data(), to.size(), static_cast<off_t>(offset));
        if (size < 0 && errno == EINTR)
        {
            continue;
        }
        if (size <= 0)
        {
            return false;
        }
        to = to.subspan(static_cast<std::size_t>(size));
        offset += static_cast<std::uint64_t>(size);
    }
    return true;
}

}  // namespace Rabit::Mcap
