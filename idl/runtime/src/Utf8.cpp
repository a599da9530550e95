#include <rabit/idl/Utf8.h>

#include <cstdint>

namespace Rabit::Idl
{

std::size_t Utf8CharacterSize(std::string_view text, std::size_t at)
{
    const auto byte = [&](std::size_t ahead)
    { return at + ahead < text.size() ? static_cast<std::uint8_t>(text[at + ahead]) : std::uint8_t{0}; };
    const auto isTail = [&](std::size_t ahead) { return (byte(ahead) & 0xc0) == 0x80; };
    const std::uint8_t first = byte(0);
    const std::uint8_t second = byte(1);
    if (first < 0x80)
    {
        return at < text.size() ? 1 : 0;
    }
    if (first >= 0xc2 && first <= 0xdf)
    {
        return isTail(1) ? 2 : 0;
    }
    if (first >= 0xe0 && first <= 0xef)
    {
        const bool isProper = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second <= 0x9f);
        return isProper && isTail(1) && isTail(2) ? 3 : 0;
    }
    if (first >= 0xf0 && first <= 0xf4)
    {
        const bool isProper = (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second <= 0x8f);
        return isProper && isTail(1) && isTail(2) && isTail(3) ? 4 : 0;
    }
    return 0;
}

}  // namespace Rabit::Idl
