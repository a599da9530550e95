#include "model/LiteralText.h"

#include <charconv>

namespace RabitIdl
{

std::string Quote(const std::string &text)
{
    static const char digits[] = "01234567";
    std::string quoted = "\"";
    for (const char letter : text)
    {
        const auto code = static_cast<unsigned char>(letter);
        if (letter == '"' || letter == '\\')
        {
            quoted += '\\';
            quoted += letter;
        }
        else if (code < 0x20 || code >= 0x7f || letter == '?')
        {
            // An escape of three octal digits ends by itself, whatever character follows.
            quoted += '\\';
            quoted += digits[code >> 6];
            quoted += digits[(code >> 3) & 7];
            quoted += digits[code & 7];
        }
        else
        {
            quoted += letter;
        }
    }
    return quoted + "\"";
}

std::string Number(double value)
{
    char digits[64];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    std::string text(digits, result.ptr);
    if (text.find_first_of(".e") == std::string::npos)
    {
        text += ".0";
    }
    return text;
}

}  // namespace RabitIdl
