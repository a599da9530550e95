#pragma once

#include "recording/RecordingDisk.h"

namespace Rabit
{

// A folder of the file system. Create makes it if it is missing.
class FolderDisk final : public RecordingDisk
{
public:
    explicit FolderDisk(std::string folder);

    std::unique_ptr<File> Create(const std::string &name, std::string &reason) override;
    std::vector<Entry> List() override;
    bool Remove(const std::string &name) override;
    std::optional<std::uint64_t> FreeBytes() override;

private:
    const std::string _folder;
};

}  // namespace Rabit
