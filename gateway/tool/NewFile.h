#pragma once

#include <rabit/mcap/FileSink.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace Rabit::Tool
{

// A file that a command makes.
class NewFile
{
public:
    // Throws std::runtime_error if the name is taken, or the file cannot be made.
    explicit NewFile(const std::filesystem::path &path) : _path(path), _sink(path.string()) {}

    Mcap::ByteSink &Sink() { return _sink; }
    // Removes the file, and throws std::runtime_error, if not all of it was written.
    void Finish(bool isWritten, bool wasStopped = false)
    {
        if (wasStopped || !isWritten || !_sink.Sync())
        {
            std::error_code ignored;
            std::filesystem::remove(_path, ignored);
            throw std::runtime_error(_path.string() + (wasStopped
                                                           ? ": was not finished, and is removed"
                                                           : ": the disk takes no more; it is removed"));
        }
    }

private:
    const std::filesystem::path _path;
    Mcap::FileSink _sink;
};

}  // namespace Rabit::Tool
