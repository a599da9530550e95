#include "dynamic/JsonSink.h"

#include "dynamic/JsonText.h"

namespace Rabit::Dynamic
{

void JsonSink::Char(char value)
{
    // The Unicode character with this number, as in Latin 1.
    const auto code = static_cast<std::uint8_t>(value);
    const char two[] = {static_cast<char>(0xc0 | code >> 6), static_cast<char>(0x80 | (code & 0x3f))};
    AppendJsonText(_out, code < 0x80 ? std::string_view(&value, 1) : std::string_view(two, 2));
}

void JsonSink::Text(std::string_view text)
{
    if (IsUtf8(text))
    {
        AppendJsonText(_out, text);
        return;
    }
    _out += "{\"base64\":\"";
    AppendBase64(_out, {reinterpret_cast<const std::uint8_t *>(text.data()), text.size()});
    _out += "\"}";
}

void JsonSink::Bits(const Shape &shape, std::uint64_t mask)
{
    const char *separator = "";
    _out += '[';
    for (const NamedNumber &bit : shape.Names)
    {
        if ((mask & bit.Number) != 0)
        {
            _out += separator;
            _out += '"';
            _out += bit.Name;
            _out += '"';
            separator = ",";
        }
    }
    _out += ']';
}

void JsonSink::Octets(std::span<const std::uint8_t> bytes, bool)
{
    _out += '"';
    AppendBase64(_out, bytes);
    _out += '"';
}

void JsonSink::BeginUnion(const Shape &shape, std::int64_t label, int place)
{
    _out += '{';
    const Part *part = place == NoCase ? nullptr : &shape.Parts[static_cast<std::size_t>(place)];
    if (part == nullptr || part->Label != label)
    {
        _out += "\"_d\":";
        Label(*shape.Discriminator, label);
        _out += part == nullptr ? "" : ",";
    }
    if (part != nullptr)
    {
        _out += part->Quoted;
    }
}

void JsonSink::Label(const Shape &discriminator, std::int64_t label)
{
    switch (discriminator.What)
    {
        case Kind::Bool:
            Bool(label != 0);
            break;
        case Kind::Char:
            Char(static_cast<char>(label));
            break;
        case Kind::Enum:
            Enumerator(discriminator, *EnumeratorOf(discriminator, static_cast<std::uint64_t>(label)));
            break;
        case Kind::Uint64:
            Number(static_cast<std::uint64_t>(label));
            break;
        case Kind::Int64:
            Number(label);
            break;
        case Kind::Uint32:
            Number(static_cast<std::uint32_t>(label));
            break;
        default:
            Number(static_cast<std::int32_t>(label));
    }
}

}  // namespace Rabit::Dynamic
