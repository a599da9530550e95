#include "PcapFile.h"

#include <array>
#include <cstdint>
#include <stdexcept>

namespace Rabit::Radio
{
namespace
{

template <std::size_t Words>
void Put(std::ofstream &file, const std::array<std::uint32_t, Words> &words)
{
    file.write(reinterpret_cast<const char *>(words.data()), sizeof(words));
}

}  // namespace

PcapFile::PcapFile(const std::string &path, Time beginning)
    : _file(path, std::ios::binary | std::ios::trunc), _beginning(beginning)
{
    constexpr std::uint32_t Nanoseconds = 0xa1b23c4d;
    constexpr std::uint32_t MajorIs2MinorIs4 = 2 | 4 << 16;  // as two 16-bit numbers in this machine's order
    constexpr std::uint32_t MostBytes = 262'144;
    constexpr std::uint32_t Ethernet = 1;
    Put<6>(_file, {Nanoseconds, MajorIs2MinorIs4, 0, 0, MostBytes, Ethernet});
    if (!_file.flush())
    {
        throw std::runtime_error("cannot write " + path);
    }
}

bool PcapFile::Write(Time at, const Frame &frame)
{
    constexpr std::int64_t Nano = 1'000'000'000;
    const std::int64_t time = (_beginning + at).count();
    const auto bytes = static_cast<std::uint32_t>(frame.size());
    Put<4>(_file,
           {static_cast<std::uint32_t>(time / Nano), static_cast<std::uint32_t>(time % Nano), bytes, bytes});
    _file.write(reinterpret_cast<const char *>(frame.data()), static_cast<std::streamsize>(frame.size()));
    return static_cast<bool>(_file);
}

}  // namespace Rabit::Radio
