#include "keys/KeyFiles.h"

#include <rabit/keys/KeysError.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <span>
#include <system_error>

namespace Rabit::Keys
{
namespace
{

constexpr std::size_t LargestFile = 1u << 20;
constexpr mode_t OwnerOnly = 0600;
constexpr mode_t ForAll = 0644;
constexpr mode_t OfOthers = 077;

std::string Reason()
{
    return std::generic_category().message(errno);
}

class Descriptor
{
public:
    Descriptor(const std::string &file, int flags, mode_t mode, const char *what)
        : Descriptor(::open(file.c_str(), flags | O_CLOEXEC, mode), what, file)
    {
    }
    // Owns an open file; negative: throws the reason.
    Descriptor(int number, const char *what, const std::string &file) : _number(number)
    {
        if (_number < 0)
        {
            throw KeysError("cannot " + std::string(what) + " " + file + ": " + Reason());
        }
    }
    ~Descriptor() { ::close(_number); }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    int Get() const { return _number; }

private:
    const int _number;
};

std::string ModeText(mode_t mode)
{
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "%03o", static_cast<unsigned>(mode & 0777));
    return text.data();
}

void CheckMode(const struct stat &status, const std::string &file, const char *remedy)
{
    if ((status.st_mode & OfOthers) != 0)
    {
        throw KeysError(file + " is not for its owner alone (mode " + ModeText(status.st_mode) +
                        "): others may have read it. " + remedy);
    }
}

// Reads up to `size` next bytes of a file. Returns their number; 0 at its end.
std::size_t ReadSome(const Descriptor &descriptor, const std::string &file, char *to, std::size_t size)
{
    ssize_t got = 0;
    do
    {
        got = ::read(descriptor.Get(), to, size);
    } while (got < 0 && errno == EINTR);
    if (got < 0)
    {
        throw KeysError("cannot read " + file + ": " + Reason());
    }
    return static_cast<std::size_t>(got);
}

std::string Read(const std::string &file, bool secret)
{
    // Opening a FIFO must not wait for a writer.
    const Descriptor descriptor(file, O_RDONLY | O_NONBLOCK, 0, "read");
    struct stat status = {};
    if (::fstat(descriptor.Get(), &status) != 0 || !S_ISREG(status.st_mode))
    {
        throw KeysError(file + " is no file");
    }
    if (secret)
    {
        CheckMode(status, file, "Make new keys, or `chmod 600` if you are sure");
    }
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t got = ReadSome(descriptor, file, part.data(), part.size()))
    {
        text.append(part.data(), got);
        if (text.size() > LargestFile)
        {
            throw KeysError(file + " is larger than 1 MiB");
        }
    }
    return text;
}

void WriteAll(const Descriptor &descriptor, const std::string &file, std::string_view text)
{
    while (!text.empty())
    {
        const ssize_t written = ::write(descriptor.Get(), text.data(), text.size());
        if (written < 0 && errno != EINTR)
        {
            throw KeysError("cannot write " + file + ": " + Reason());
        }
        text.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    if (::fsync(descriptor.Get()) != 0)
    {
        throw KeysError("cannot write " + file + ": " + Reason());
    }
}

void Write(const std::string &file, std::string_view text, mode_t mode)
{
    const std::string temporary = file + ".new";
    ::unlink(temporary.c_str());
    try
    {
        {
            const Descriptor descriptor(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, mode, "write");
            WriteAll(descriptor, file, text);
        }
        if (::rename(temporary.c_str(), file.c_str()) != 0)
        {
            throw KeysError("cannot write " + file + ": " + Reason());
        }
    }
    catch (const KeysError &)
    {
        ::unlink(temporary.c_str());
        throw;
    }
}

}  // namespace

std::string ReadFile(const std::string &file)
{
    return Read(file, false);
}

std::string ReadSecret(const std::string &file)
{
    return Read(file, true);
}

Secret ReadPassphrase(const std::string &file)
{
    const Descriptor descriptor(file, O_RDONLY, 0, "read");
    struct stat status = {};
    if (::fstat(descriptor.Get(), &status) != 0 || (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)))
    {
        throw KeysError(file + " is neither a file nor a pipe");
    }
    if (S_ISREG(status.st_mode))
    {
        CheckMode(status, file, "Choose another passphrase, or `chmod 600` if you are sure");
    }
    Secret passphrase;
    const std::span<char> room(passphrase.Room(), LongestPassphrase + 1);
    std::size_t size = 0;
    std::size_t got = 0;
    do
    {
        got = ReadSome(descriptor, file, room.data() + size, room.size() - size);
        size += got;
    } while (got > 0 && size < room.size() && std::count(room.begin(), room.end(), '\n') == 0);
    const auto lineEnd = std::find(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size), '\n');
    try
    {
        passphrase.Resize(static_cast<std::size_t>(lineEnd - room.begin()));
    }
    catch (const KeysError &error)
    {
        throw KeysError("the first line of " + file + " is " + error.what());
    }
    return passphrase;
}

void WriteSecret(const std::string &file, std::string_view text)
{
    Write(file, text, OwnerOnly);
}

bool WriteNewSecret(const std::string &file, std::string_view text)
{
    // A name of its own: another program may be writing the same secret.
    std::string temporary = file + ".XXXXXX";
    const Descriptor descriptor(::mkostemp(temporary.data(), O_CLOEXEC), "write", file);
    const struct Unlink
    {
        const std::string &Name;
        ~Unlink() { ::unlink(Name.c_str()); }
    } unlink{temporary};
    WriteAll(descriptor, file, text);
    if (::link(temporary.c_str(), file.c_str()) == 0)
    {
        return true;
    }
    if (errno != EEXIST)
    {
        throw KeysError("cannot write " + file + ": " + Reason());
    }
    return false;
}

void WriteFile(const std::string &file, std::string_view text)
{
    Write(file, text, ForAll);
}

void MakeSecretFolder(const std::string &folder)
{
    constexpr mode_t ownerOnly = 0700;
    if (::mkdir(folder.c_str(), ownerOnly) != 0)
    {
        throw KeysError("cannot make the folder " + folder + ": " + Reason());
    }
}

}  // namespace Rabit::Keys
