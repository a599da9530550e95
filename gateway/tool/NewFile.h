#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "recording/FolderDisk.h"

namespace Rabit::Tool
{

// A file that a command makes.
class NewFile
{
public:
    // Throws std::runtime_error if the name is taken, or the file cannot be made.
    explicit NewFile(const std::filesystem::path &path)
        : _path(path), _disk(path.has_parent_path() ? path.parent_path().string() : ".")
    {
        std::string reason;
        _file = _disk.Create(path.filename().string(), reason);
        if (_file == nullptr)
        {
            throw std::runtime_error(reason);
        }
    }

    RecordingDisk::File &Sink() { return *_file; }
    // Removes the file, and throws std::runtime_error, if not all of it was written.
    void Finish(bool isWritten, bool wasStopped = false)
    {
        if (wasStopped || !isWritten || !_file->Sync())
        {
            _disk.Remove(_path.filename().string());
            throw std::runtime_error(_path.string() + (wasStopped
                                                           ? ": was not finished, and is removed"
                                                           : ": the disk takes no more; it is removed"));
        }
    }

private:
    const std::filesystem::path _path;
    FolderDisk _disk;
    std::unique_ptr<RecordingDisk::File> _file;
};

}  // namespace Rabit::Tool
