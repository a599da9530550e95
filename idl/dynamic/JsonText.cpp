#include "dynamic/JsonText.h"

#include <rabit/idl/Utf8.h>

namespace Rabit::Dynamic
{
namespace
{

constexpr std::string_view Base64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::uint8_t At(std::string_view text, std::size_t at)
{
    return at < text.size() ? static_cast<std::uint8_t>(text[at]) : 0;
}

void AppendEscape(std::string &out, unsigned code)
{
    static constexpr char hex[] = "0123456789abcdef";
    out += "\\u00";
    out += hex[code >> 4 & 15];
    out += hex[code & 15];
}

}  // namespace

bool IsUtf8(std::string_view text)
{
    for (std::size_t at = 0; at < text.size();)
    {
        const std::size_t size = Idl::Utf8CharacterSize(text, at);
        if (size == 0)
        {
            return false;
        }
        at += size;
    }
    return true;
}

void AppendJsonText(std::string &out, std::string_view utf8)
{
    out += '"';
    std::size_t plain = 0;  // start of the part that is not appended yet
    for (std::size_t at = 0; at < utf8.size(); ++at)
    {
        const std::uint8_t byte = At(utf8, at);
        const bool isC1 = byte == 0xc2 && At(utf8, at + 1) < 0xa0 && at + 1 < utf8.size();
        if (byte >= 0x20 && byte != '"' && byte != '\\' && byte != 0x7f && !isC1)
        {
            continue;
        }
        out.append(utf8.substr(plain, at - plain));
        if (isC1)
        {
            AppendEscape(out, At(utf8, ++at));
        }
        else if (byte == '"' || byte == '\\')
        {
            out += '\\';
            out += static_cast<char>(byte);
        }
        else if (byte == '\n')
        {
            out += "\\n";
        }
        else if (byte == '\t')
        {
            out += "\\t";
        }
        else
        {
            AppendEscape(out, byte);
        }
        plain = at + 1;
    }
    out.append(utf8.substr(plain));
    out += '"';
}

void AppendBase64(std::string &out, std::span<const std::uint8_t> bytes)
{
    for (std::size_t at = 0; at < bytes.size(); at += 3)
    {
        const std::size_t left = bytes.size() - at;
        const unsigned group = static_cast<unsigned>(bytes[at] << 16) |
                               static_cast<unsigned>(left > 1 ? bytes[at + 1] << 8 : 0) |
                               static_cast<unsigned>(left > 2 ? bytes[at + 2] : 0);
        out += Base64[group >> 18];
        out += Base64[group >> 12 & 63];
        out += left > 1 ? Base64[group >> 6 & 63] : '=';
        out += left > 2 ? Base64[group & 63] : '=';
    }
}

std::optional<std::vector<std::uint8_t>> FromBase64(std::string_view text)
{
    if (text.size() % 4 != 0)
    {
        return std::nullopt;
    }
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (std::size_t at = 0; at < text.size(); at += 4)
    {
        unsigned group = 0;
        unsigned missing = 0;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const char letter = text[at + i];
            const std::size_t digit = Base64.find(letter);
            const bool isPadding = letter == '=' && at + 4 == text.size() && i >= 2;
            if ((digit == Base64.npos && !isPadding) || (missing != 0 && !isPadding))
            {
                return std::nullopt;
            }
            missing += isPadding ? 1 : 0;
            group = group << 6 | static_cast<unsigned>(isPadding ? 0 : digit);
        }
        const unsigned unused = missing == 2 ? 0xffff : missing == 1 ? 0xff : 0;
        if ((group & unused) != 0)
        {
            return std::nullopt;  // leftover bits that belong to no byte
        }
        for (unsigned i = 0; i < 3 - missing; ++i)
        {
            bytes.push_back(static_cast<std::uint8_t>(group >> (16 - 8 * i)));
        }
    }
    return bytes;
}

}  // namespace Rabit::Dynamic
