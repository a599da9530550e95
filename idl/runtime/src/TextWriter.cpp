#include <rabit/idl/TextWriter.h>
#include <rabit/idl/Utf8.h>

namespace Rabit::Idl
{

void TextWriter::Quoted(std::string_view text, char quote)
{
    static constexpr char hex[] = "0123456789abcdef";
    _text += quote;
    for (std::size_t at = 0; at < text.size();)
    {
        const auto code = static_cast<std::uint8_t>(text[at]);
        const std::size_t size = Utf8CharacterSize(text, at);
        const bool isControl = code < 0x20 || code == 0x7f ||
                               (code == 0xc2 && size == 2 && static_cast<std::uint8_t>(text[at + 1]) < 0xa0);
        if (size == 0 || isControl)
        {
            for (const std::size_t end = at + (size == 0 ? 1 : size); at < end; ++at)
            {
                const auto byte = static_cast<std::uint8_t>(text[at]);
                _text += "\\x";
                _text += hex[byte >> 4];
                _text += hex[byte & 15];
            }
            continue;
        }
        if (text[at] == quote || text[at] == '\\')
        {
            _text += '\\';
        }
        _text.append(text.substr(at, size));
        at += size;
    }
    _text += quote;
}

}  // namespace Rabit::Idl
