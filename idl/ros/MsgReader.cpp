#include "ros/MsgReader.h"

#include "model/Names.h"

#include <strings.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace RabitIdl
{
namespace
{

constexpr const char *Blanks = " \t\r\f\v";

std::string Trimmed(const std::string &text)
{
    const std::size_t first = text.find_first_not_of(Blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(Blanks) - first + 1);
}

bool IsIdentifier(const std::string &text)
{
    return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
           std::all_of(text.begin(), text.end(),
                       [](unsigned char letter) { return std::isalnum(letter) != 0 || letter == '_'; });
}

// The position at which the remark begins; quoted text is skipped.
std::size_t RemarkIn(const std::string &line)
{
    char quote = '\0';
    for (std::size_t i = 0; i < line.size(); ++i)
    {
        if (quote != '\0' && line[i] == '\\')
        {
            ++i;
        }
        else if (quote != '\0')
        {
            quote = line[i] == quote ? '\0' : quote;
        }
        else if ((line[i] == '"' || line[i] == '\'') && i > 0 &&
                 std::string(" =\t").find(line[i - 1]) != std::string::npos &&
                 line.find(line[i], i + 1) != std::string::npos)
        {
            quote = line[i];
        }
        else if (line[i] == '#')
        {
            return i;
        }
    }
    return std::string::npos;
}

std::optional<std::uint32_t> Count(const std::string &text)
{
    std::uint32_t count = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), count);
    return result.ec == std::errc() && result.ptr == text.data() + text.size() && count > 0
               ? std::optional(count)
               : std::nullopt;
}

template <class T>
MsgType Integer(const char *idl)
{
    MsgType type;
    type.What = MsgType::Kind::Integer;
    type.Idl = idl;
    type.Least = static_cast<std::int64_t>(std::numeric_limits<T>::min());
    type.Most = static_cast<std::uint64_t>(std::numeric_limits<T>::max());
    return type;
}

MsgType Other(MsgType::Kind kind, const char *idl)
{
    MsgType type;
    type.What = kind;
    type.Idl = idl;
    return type;
}

// ROS 2's `char` is a number without a sign.
const std::map<std::string, MsgType> &Builtins()
{
    static const std::map<std::string, MsgType> table{{"bool", Other(MsgType::Kind::Bool, "boolean")},
                                                      {"byte", Integer<std::uint8_t>("octet")},
                                                      {"char", Integer<std::uint8_t>("uint8")},
                                                      {"int8", Integer<std::int8_t>("int8")},
                                                      {"uint8", Integer<std::uint8_t>("uint8")},
                                                      {"int16", Integer<std::int16_t>("int16")},
                                                      {"uint16", Integer<std::uint16_t>("uint16")},
                                                      {"int32", Integer<std::int32_t>("int32")},
                                                      {"uint32", Integer<std::uint32_t>("uint32")},
                                                      {"int64", Integer<std::int64_t>("int64")},
                                                      {"uint64", Integer<std::uint64_t>("uint64")},
                                                      {"float32", Other(MsgType::Kind::Float, "float")},
                                                      {"float64", Other(MsgType::Kind::Float, "double")},
                                                      {"string", Other(MsgType::Kind::String, "string")}};
    return table;
}

}  // namespace

MsgFile MsgReader::Read(const std::string &text, const std::string &package, const std::string &name)
{
    _file.Package = package;
    _file.Name = name;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        ++_line;
        ReadLine(line);
    }
    if (_file.Comment.empty() && _file.Constants.empty() && _file.Fields.empty())
    {
        _file.Comment = std::move(_comment);
    }
    return std::move(_file);
}

void MsgReader::Refuse(const std::string &message)
{
    _refusals.Add(_path, _line, message);
}

void MsgReader::ReadLine(std::string line)
{
    const std::size_t remark = RemarkIn(line);
    const std::string code = Trimmed(line.substr(0, remark));
    if (code.empty() && remark == std::string::npos)
    {
        // A comment block at the beginning is about the whole message.
        if (_file.Constants.empty() && _file.Fields.empty() && _file.Comment.empty())
        {
            _file.Comment = std::move(_comment);
        }
        _comment.clear();
        _last = nullptr;
        return;
    }
    const std::size_t said = remark == std::string::npos ? remark : line.find_first_not_of('#', remark);
    const std::string words = said == std::string::npos ? "" : Trimmed(line.substr(said));
    if (code.empty())
    {
        // An indented comment below an entry continues the remark behind it.
        if (remark > 0 && _last != nullptr)
        {
            TakeRemark(words);
        }
        else
        {
            TakeComment(words);
        }
        return;
    }
    ReadEntry(code);
    if (!words.empty() && _last != nullptr)
    {
        TakeRemark(words);
    }
}

void MsgReader::TakeComment(const std::string &text)
{
    _last = nullptr;
    _comment.push_back(text);
}

void MsgReader::TakeRemark(const std::string &text)
{
    _last->Comment.push_back(text);
}

void MsgReader::ReadEntry(const std::string &line)
{
    MsgEntry entry;
    entry.Comment = std::exchange(_comment, {});
    _last = nullptr;
    const std::size_t end = line.find_first_of(Blanks);
    if (end == std::string::npos)
    {
        Refuse("expected a type and a name, found `" + line + "`");
        return;
    }
    entry.Type = ReadType(line.substr(0, end));
    const std::string rest = Trimmed(line.substr(end));
    const std::size_t equal = rest.find('=');
    const bool isConstant = equal != std::string::npos && IsIdentifier(Trimmed(rest.substr(0, equal)));
    const std::size_t nameEnd = isConstant ? equal : rest.find_first_of(Blanks);
    entry.Name = Trimmed(rest.substr(0, nameEnd));
    const std::string value =
        nameEnd == std::string::npos ? "" : Trimmed(rest.substr(nameEnd + (isConstant ? 1 : 0)));
    CheckName(entry, isConstant);
    if (isConstant && (entry.Type.What == MsgType::Kind::Message ||
                       entry.Type.Several != MsgType::Array::None || entry.Type.Bound != 0))
    {
        Refuse("a constant cannot be of this type");
        return;
    }
    if (isConstant || !value.empty())
    {
        entry.Value = ReadValue(entry.Type, value);
    }
    std::vector<MsgEntry> &list = isConstant ? _file.Constants : _file.Fields;
    if (std::any_of(list.begin(), list.end(),
                    [&entry](const MsgEntry &other) { return other.Name == entry.Name; }))
    {
        Refuse("'" + entry.Name + "' is there twice");
    }
    list.push_back(std::move(entry));
    _last = &list.back();
}

void MsgReader::CheckName(const MsgEntry &entry, bool isConstant)
{
    const char *what = isConstant ? "a constant" : "a field";
    if (!IsIdentifier(entry.Name))
    {
        Refuse("`" + entry.Name + "` is no name of " + what);
        return;
    }
    const std::string reason = WhyNotCpp(entry.Name);
    if (!reason.empty())
    {
        Refuse("'" + entry.Name + "' " + reason);
    }
}

MsgType MsgReader::ReadType(const std::string &text)
{
    const std::size_t bracket = text.find('[');
    MsgType type = ReadElement(text.substr(0, bracket));
    if (bracket == std::string::npos)
    {
        return type;
    }
    if (text.back() != ']')
    {
        Refuse("expected `]` at the end of `" + text + "`");
        return type;
    }
    std::string length = text.substr(bracket + 1, text.size() - bracket - 2);
    if (length.empty())
    {
        type.Several = MsgType::Array::Unbounded;
        return type;
    }
    type.Several = MsgType::Array::Fixed;
    if (length.compare(0, 2, "<=") == 0)
    {
        type.Several = MsgType::Array::Bounded;
        length.erase(0, 2);
    }
    type.Length = Count(length).value_or(0);
    if (type.Length == 0)
    {
        Refuse("`" + length + "` is no length of an array; expected 1 to 4294967295");
    }
    return type;
}

MsgType MsgReader::ReadElement(const std::string &text)
{
    const std::size_t bound = text.find("<=");
    const std::string name = text.substr(0, bound);
    if (name == "wstring")
    {
        Refuse("type wstring is not supported: ROS 2's implementations do not agree on its bytes");
        return {};
    }
    if (name == "time" || name == "duration")
    {
        Refuse("type " + name + " is of ROS 1; expected builtin_interfaces/" +
               (name == "time" ? "Time" : "Duration"));
        return {};
    }
    const auto builtin = Builtins().find(name);
    if (builtin != Builtins().end())
    {
        MsgType type = builtin->second;
        if (bound != std::string::npos)
        {
            type.Bound = Count(text.substr(bound + 2)).value_or(0);
            if (type.What != MsgType::Kind::String || type.Bound == 0)
            {
                Refuse("`" + text + "` is no type");
            }
        }
        return type;
    }
    MsgType type;
    type.What = MsgType::Kind::Message;
    const std::size_t slash = text.find('/');
    type.Package = slash == std::string::npos ? _file.Package : text.substr(0, slash);
    type.Name = slash == std::string::npos ? text : text.substr(text.find_last_of('/') + 1);
    const std::string between =
        slash == std::string::npos ? "/" : text.substr(slash, text.size() - slash - type.Name.size());
    const bool isMessage = IsIdentifier(type.Package) && IsIdentifier(type.Name) &&
                           std::isupper(static_cast<unsigned char>(type.Name[0])) != 0 &&
                           (between == "/" || between == "/msg/");
    if (!isMessage)
    {
        Refuse("`" + text + "` is no type");
    }
    return type;
}

std::string MsgReader::ReadValue(const MsgType &type, const std::string &text)
{
    if (type.Several != MsgType::Array::None)
    {
        Refuse("a default of an array is not supported");
        return "";
    }
    switch (type.What)
    {
        case MsgType::Kind::Bool:
            if (strcasecmp(text.c_str(), "true") == 0 || text == "1")
            {
                return "TRUE";
            }
            if (strcasecmp(text.c_str(), "false") != 0 && text != "0")
            {
                Refuse("`" + text + "` is no value of bool; expected true or false");
            }
            return "FALSE";
        case MsgType::Kind::Integer:
            return ReadInteger(type, text);
        case MsgType::Kind::Float:
            return ReadFloat(type, text);
        case MsgType::Kind::String:
            return ReadString(type, text);
        case MsgType::Kind::Message:
            break;
    }
    Refuse("a default of a message is not supported");
    return "";
}

std::string MsgReader::ReadInteger(const MsgType &type, const std::string &text)
{
    const bool negative = !text.empty() && text[0] == '-';
    std::string digits = !text.empty() && (negative || text[0] == '+') ? text.substr(1) : text;
    int base = 10;
    const std::string prefix = digits.substr(0, 2);
    if (prefix == "0x" || prefix == "0X" || prefix == "0b" || prefix == "0B" || prefix == "0o" ||
        prefix == "0O")
    {
        base = std::tolower(static_cast<unsigned char>(prefix[1])) == 'x'   ? 16
               : std::tolower(static_cast<unsigned char>(prefix[1])) == 'b' ? 2
                                                                            : 8;
        digits.erase(0, 2);
    }
    std::uint64_t value = 0;
    const char *const end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value, base);
    const std::uint64_t lowest = std::uint64_t{0} - static_cast<std::uint64_t>(type.Least);
    if (result.ec != std::errc() || result.ptr != end || value > (negative ? lowest : type.Most))
    {
        Refuse("`" + text + "` is no value of " + type.Idl);
        return "0";
    }
    return (negative ? "-" : "") + std::to_string(value);
}

std::string MsgReader::ReadFloat(const MsgType &type, const std::string &text)
{
    errno = 0;
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const double most = type.Idl == "float" ? static_cast<double>(std::numeric_limits<float>::max())
                                            : std::numeric_limits<double>::max();
    if (text.empty() || *end != '\0' || !std::isfinite(value) || std::fabs(value) > most)
    {
        Refuse("`" + text + "` is no value of " + type.Idl + " that IDL can write");
        return "0.0";
    }
    char digits[64];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    std::string number(digits, result.ptr);
    return number.find_first_of(".e") == std::string::npos ? number + ".0" : number;
}

std::string MsgReader::ReadString(const MsgType &type, std::string text)
{
    if (text.size() >= 2 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0])
    {
        const char quote = text[0];
        std::string inner;
        for (std::size_t i = 1; i + 1 < text.size(); ++i)
        {
            const bool escapes =
                text[i] == '\\' && i + 2 < text.size() && (text[i + 1] == quote || text[i + 1] == '\\');
            i += escapes ? 1 : 0;
            inner += text[i];
        }
        text = inner;
    }
    if (type.Bound != 0 && text.size() > type.Bound)
    {
        Refuse("the default is longer than its bound");
    }
    std::string quoted = "\"";
    for (const char letter : text)
    {
        quoted += letter == '"' || letter == '\\' ? std::string("\\") + letter : std::string(1, letter);
    }
    return quoted + "\"";
}

}  // namespace RabitIdl
