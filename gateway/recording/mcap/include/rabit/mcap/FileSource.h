#pragma once

#include <rabit/mcap/ByteSource.h>

#include <string>

namespace Rabit::Mcap
{

// A file of the file system, which may be growing: Size is its size at construction. The file is open until
// the destructor. One thread at a time.
class FileSource final : public ByteSource
{
public:
    // Throws std::runtime_error, with a line for people, if it cannot be read.
    explicit FileSource(const std::string &path);
    ~FileSource() override;
    FileSource(const FileSource &) = delete;
    FileSource &operator=(const FileSource &) = delete;

    std::uint64_t Size() override { return _size; }
    bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override;

private:
    int _descriptor = -1;
    std::uint64_t _size = 0;
};

}  // namespace Rabit::Mcap
