#include "dynamic/JsonEncoder.h"

#include "dynamic/FreshValue.h"
#include "dynamic/JsonText.h"
#include "dynamic/JsonValues.h"
#include "dynamic/Limits.h"

#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace Rabit::Dynamic
{
namespace
{

std::vector<std::string> NamesOf(const std::vector<NamedNumber> &numbers)
{
    std::vector<std::string> names;
    for (const NamedNumber &one : numbers)
    {
        names.push_back(one.Name);
    }
    return names;
}

std::vector<std::string> NamesOf(const std::vector<Part> &parts)
{
    std::vector<std::string> names;
    for (const Part &part : parts)
    {
        names.push_back(part.Name);
    }
    return names;
}

template <class Named>
const Named *FindNamed(const std::vector<Named> &all, std::string_view name)
{
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Named &one) { return one.Name == name; });
    return found == all.end() ? nullptr : &*found;
}

// Appends a step to the path for as long as it lives. After a refusal the step stays, for Reason.
class Step
{
public:
    Step(std::string &path, const std::string &reason, std::string_view step)
        : _path(path), _reason(reason), _size(path.size())
    {
        _path += step;
    }
    Step(const Step &) = delete;
    Step &operator=(const Step &) = delete;
    ~Step()
    {
        if (_reason.empty())
        {
            _path.resize(_size);
        }
    }

private:
    std::string &_path;
    const std::string &_reason;
    std::size_t _size;
};

}  // namespace

bool JsonEncoder::Put(const Shape &shape, const Json &json)
{
    if (_out.Size() > MaxSampleSize)
    {
        return Refuse("the message takes more than " + std::to_string(MaxSampleSize) + " bytes");
    }
    switch (shape.What)
    {
        case Kind::Bool:
            return PutBool(json);
        case Kind::Char:
            return PutChar(json);
        case Kind::Float:
        case Kind::Double:
            return PutFloat(shape, json);
        case Kind::String:
            return PutText(shape, json);
        case Kind::Sequence:
        case Kind::Array:
            return PutList(shape, json);
        case Kind::Enum:
            return PutEnum(shape, json);
        case Kind::Bitmask:
            return PutBits(shape, json);
        case Kind::Struct:
            return PutStruct(shape, json);
        case Kind::Union:
            return PutUnion(shape, json);
        default:
            return PutInteger(shape, json);
    }
}

bool JsonEncoder::Refuse(std::string reason)
{
    _reason = std::move(reason);
    return false;
}

bool JsonEncoder::Expected(std::string_view what, const Json &json)
{
    return Refuse("expected " + std::string(what) + ", not " + Shown(json));
}

bool JsonEncoder::Unknown(std::string_view what, const std::string &word,
                          const std::vector<std::string> &known)
{
    return Refuse("no " + std::string(what) + " " + Printable(word) + NearestWordHint(word, known));
}

bool JsonEncoder::PutBool(const Json &json)
{
    if (!json.is_boolean())
    {
        return Expected("true or false", json);
    }
    _out.Put(json.get<bool>() ? 1 : 0, 1);
    return true;
}

bool JsonEncoder::PutChar(const Json &json)
{
    char value = 0;
    if (!ReadChar(json, value))
    {
        return Expected("a text of one character, U+0000 to U+00FF", json);
    }
    _out.Put(static_cast<std::uint8_t>(value), 1);
    return true;
}

bool JsonEncoder::PutInteger(const Shape &shape, const Json &json)
{
    const Range range = RangeOfKind(shape.What);
    std::uint64_t bits = 0;
    if (!ReadInteger(json, range, bits))
    {
        return Expected(
            "a whole number from " + std::to_string(range.Least) + " to " + std::to_string(range.Most), json);
    }
    _out.Put(bits, shape.Size);
    return true;
}

bool JsonEncoder::PutFloat(const Shape &shape, const Json &json)
{
    double value = 0.0;
    if (json.is_number())
    {
        value = json.get<double>();
    }
    else if (json == "NaN")
    {
        value = std::numeric_limits<double>::quiet_NaN();
    }
    else if (json == "Infinity" || json == "-Infinity")
    {
        value = json == "Infinity" ? std::numeric_limits<double>::infinity()
                                   : -std::numeric_limits<double>::infinity();
    }
    else
    {
        return Expected("a number, \"NaN\", \"Infinity\" or \"-Infinity\"", json);
    }
    if (shape.What == Kind::Double)
    {
        _out.Put(std::bit_cast<std::uint64_t>(value), 8);
        return true;
    }
    const auto single = static_cast<float>(value);
    if (std::isinf(single) && !std::isinf(value))
    {
        return Expected("a number that a float can hold, up to 3.4028235e+38", json);
    }
    _out.Put(std::bit_cast<std::uint32_t>(single), 4);
    return true;
}

bool JsonEncoder::PutText(const Shape &shape, const Json &json)
{
    std::string decoded;
    const std::string *text = json.is_string() ? json.get_ptr<const std::string *>() : nullptr;
    if (json.is_object() && json.size() == 1 && json.contains("base64") && json["base64"].is_string())
    {
        const auto bytes = FromBase64(json["base64"].get_ref<const std::string &>());
        if (!bytes)
        {
            return Refuse("expected base64, padded with =");
        }
        decoded.assign(bytes->begin(), bytes->end());
        text = &decoded;
    }
    if (text == nullptr)
    {
        return Expected("a text", json);
    }
    if (text->find('\0') != std::string::npos)
    {
        return Refuse("expected a text without the character U+0000");
    }
    if (!CheckLength(shape, text->size(), "bytes"))
    {
        return false;
    }
    _out.PutString(*text);
    return true;
}

bool JsonEncoder::CheckLength(const Shape &shape, std::size_t length, const char *what)
{
    if (shape.What == Kind::Array && length != shape.Length)
    {
        return Refuse("expected " + std::to_string(shape.Length) + " " + what + ", not " +
                      std::to_string(length));
    }
    if (shape.Bound != 0 && length > shape.Bound)
    {
        return Refuse("expected at most " + std::to_string(shape.Bound) + " " + what + ", not " +
                      std::to_string(length));
    }
    return true;
}

bool JsonEncoder::PutEnum(const Shape &shape, const Json &json)
{
    if (!json.is_string())
    {
        return Expected("the name of a value of " + shape.Name, json);
    }
    const auto &name = json.get_ref<const std::string &>();
    const NamedNumber *value = FindNamed(shape.Names, name);
    if (value == nullptr)
    {
        return Unknown("value of " + shape.Name + " is named", name, NamesOf(shape.Names));
    }
    _out.Put(value->Number, shape.Size);
    return true;
}

bool JsonEncoder::PutBits(const Shape &shape, const Json &json)
{
    if (!json.is_array())
    {
        return Expected("a list of names of bits of " + shape.Name, json);
    }
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < json.size(); ++i)
    {
        const Step step(_path, _reason, "[" + std::to_string(i) + "]");
        if (!json[i].is_string())
        {
            return Expected("the name of a bit of " + shape.Name, json[i]);
        }
        const auto &name = json[i].get_ref<const std::string &>();
        const NamedNumber *bit = FindNamed(shape.Names, name);
        if (bit == nullptr)
        {
            return Unknown("bit of " + shape.Name + " is named", name, NamesOf(shape.Names));
        }
        mask |= bit->Number;
    }
    _out.Put(mask, shape.Size);
    return true;
}

bool JsonEncoder::PutList(const Shape &shape, const Json &json)
{
    if (shape.Element->What == Kind::Octet && json.is_string())
    {
        return PutOctets(shape, json);
    }
    if (!json.is_array())
    {
        return Expected(shape.Element->What == Kind::Octet ? "base64 or a list" : "a list", json);
    }
    if (!CheckLength(shape, json.size(), "elements"))
    {
        return false;
    }
    if (shape.What == Kind::Sequence)
    {
        _out.Put(json.size(), 4);
    }
    for (std::size_t i = 0; i < json.size(); ++i)
    {
        const Step step(_path, _reason, "[" + std::to_string(i) + "]");
        if (!Put(*shape.Element, json[i]))
        {
            return false;
        }
    }
    return true;
}

bool JsonEncoder::PutOctets(const Shape &shape, const Json &json)
{
    const auto bytes = FromBase64(json.get_ref<const std::string &>());
    if (!bytes)
    {
        return Expected("base64, padded with =", json);
    }
    if (!CheckLength(shape, bytes->size(), "octets"))
    {
        return false;
    }
    if (shape.What == Kind::Sequence)
    {
        _out.Put(bytes->size(), 4);
    }
    _out.PutBytes(*bytes);
    return true;
}

bool JsonEncoder::PutStruct(const Shape &shape, const Json &json)
{
    if (!json.is_object())
    {
        return Expected("an object", json);
    }
    for (const auto &[name, value] : json.items())
    {
        if (FindNamed(shape.Parts, name) == nullptr)
        {
            return Unknown("member of " + shape.Name + " is named", name, NamesOf(shape.Parts));
        }
    }
    for (const Part &part : shape.Parts)
    {
        const auto value = json.find(part.Name);
        if (value == json.end())
        {
            PutFresh(_out, part);
            continue;
        }
        const Step step(_path, _reason, (_path.empty() ? "" : ".") + part.Name);
        if (!Put(*part.Type, *value))
        {
            return false;
        }
    }
    return true;
}

bool JsonEncoder::PutUnion(const Shape &shape, const Json &json)
{
    if (!json.is_object())
    {
        return Expected("an object that names one case", json);
    }
    const Part *selected = nullptr;
    const Json *content = nullptr;
    const Json *discriminator = nullptr;
    for (const auto &[name, value] : json.items())
    {
        if (name == "_d")
        {
            discriminator = &value;
            continue;
        }
        const Part *part = FindNamed(shape.Parts, name);
        if (part == nullptr)
        {
            return Unknown("case of " + shape.Name + " is named", name, NamesOf(shape.Parts));
        }
        if (selected != nullptr)
        {
            return Refuse("expected one case, not both " + Printable(selected->Name) + " and " +
                          Printable(name));
        }
        selected = part;
        content = &value;
    }
    if (selected == nullptr && discriminator == nullptr)
    {
        PutFresh(_out, shape);
        return true;
    }
    std::int64_t label = selected == nullptr ? 0 : selected->Label;
    if (discriminator != nullptr)
    {
        const Step step(_path, _reason, _path.empty() ? "_d" : "._d");
        if (!ReadLabel(*shape.Discriminator, *discriminator, label))
        {
            return false;
        }
        const int place = CaseOf(shape, label);
        const Part *named = place < 0 ? nullptr : &shape.Parts[static_cast<std::size_t>(place)];
        if (place == NotAllowed)
        {
            return Expected("a discriminator of " + shape.Name, *discriminator);
        }
        if (selected != nullptr && named != selected)
        {
            return Expected("a discriminator that selects " + Printable(selected->Name), *discriminator);
        }
        selected = named;
    }
    _out.Put(static_cast<std::uint64_t>(label), shape.Discriminator->Size);
    if (selected == nullptr)
    {
        return true;
    }
    if (content == nullptr)
    {
        PutFresh(_out, *selected->Type);
        return true;
    }
    const Step step(_path, _reason, (_path.empty() ? "" : ".") + selected->Name);
    return Put(*selected->Type, *content);
}

bool JsonEncoder::ReadLabel(const Shape &discriminator, const Json &json, std::int64_t &label)
{
    std::uint64_t bits = 0;
    char letter = 0;
    switch (discriminator.What)
    {
        case Kind::Bool:
            label = json.is_boolean() && json.get<bool>() ? 1 : 0;
            return json.is_boolean() || Expected("true or false", json);
        case Kind::Char:
            label = ReadChar(json, letter) ? letter : 0;
            return ReadChar(json, letter) || Expected("a text of one character", json);
        case Kind::Enum:
        {
            const NamedNumber *value =
                json.is_string() ? FindNamed(discriminator.Names, json.get_ref<const std::string &>())
                                 : nullptr;
            if (value == nullptr)
            {
                return json.is_string()
                           ? Unknown("value of " + discriminator.Name + " is named",
                                     json.get_ref<const std::string &>(), NamesOf(discriminator.Names))
                           : Expected("the name of a value of " + discriminator.Name, json);
            }
            label = static_cast<std::int64_t>(value->Number);
            return true;
        }
        default:
        {
            const Range range = RangeOfKind(discriminator.What);
            label = 0;
            const bool fits = ReadInteger(json, range, bits);
            label = static_cast<std::int64_t>(bits);
            return fits || Expected("a whole number from " + std::to_string(range.Least) + " to " +
                                        std::to_string(range.Most),
                                    json);
        }
    }
}

}  // namespace Rabit::Dynamic
