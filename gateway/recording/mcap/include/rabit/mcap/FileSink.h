#pragma once

#include <rabit/mcap/ByteSink.h>

#include <string>

namespace Rabit::Mcap
{

// A new file of the file system, readable by its owner and its group. The file is open until the destructor.
// One thread at a time.
class FileSink final : public ByteSink
{
public:
    // Makes the file, and its folder if that is missing. No file is overwritten. Throws std::runtime_error,
    // with a line for people, if the name is taken, or the file or the folder cannot be made.
    explicit FileSink(const std::string &path);
    ~FileSink() override;
    FileSink(const FileSink &) = delete;
    FileSink &operator=(const FileSink &) = delete;

    bool Write(ByteView bytes) override;
    // Returns when all written bytes would survive a power loss; false if that fails.
    bool Sync();

private:
    const int _descriptor;
};

}  // namespace Rabit::Mcap
