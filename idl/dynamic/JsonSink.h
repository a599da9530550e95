// A sink of a walk that writes the value as JSON, in the form that DynamicType.h describes.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <charconv>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace Rabit::Dynamic
{

class JsonSink
{
public:
    // If the text exceeds maxSize, Ok() is false. `isWideText`: integers of 64 bits are written as text.
    JsonSink(std::string &out, std::size_t maxSize, bool isWideText)
        : _out(out), _maxSize(maxSize), _isWideText(isWideText)
    {
    }

    void Bool(bool value) { _out += value ? "true" : "false"; }
    void Char(char value);
    template <class T>
    void Number(T value)
    {
        if constexpr (std::is_floating_point_v<T>)
        {
            if (!std::isfinite(value))
            {
                _out += std::isnan(value) ? "\"NaN\"" : value < 0 ? "\"-Infinity\"" : "\"Infinity\"";
                return;
            }
            if (value == 0 && std::signbit(value))
            {
                _out += "-0.0";  // -0 would be read as an integer, which has no sign at 0
                return;
            }
        }
        if constexpr (std::is_same_v<T, float>)
        {
            // The only float (all were checked) that its shortest digits do not restore: read as a double,
            // as JSON is, they lie halfway to the next float and round to that.
            if (std::fabs(value) == 0x1.5c87fap-84F)
            {
                Number(static_cast<double>(value));
                return;
            }
        }
        const bool isText = _isWideText && std::is_integral_v<T> && sizeof value == 8;
        char digits[32];
        const auto result = std::to_chars(digits, digits + sizeof digits, value);
        _out.append(isText ? "\"" : "").append(digits, result.ptr).append(isText ? "\"" : "");
    }
    void Text(std::string_view text);
    void Enumerator(const Shape &, const NamedNumber &value)
    {
        _out += '"';
        _out += value.Name;
        _out += '"';
    }
    void Bits(const Shape &shape, std::uint64_t mask);
    void Octets(std::span<const std::uint8_t> bytes, bool isSequence);
    void BeginList(std::size_t, bool) { _out += '['; }
    void Element(std::size_t index)
    {
        if (index != 0)
        {
            _out += ',';
        }
    }
    void EndList() { _out += ']'; }
    void BeginStruct() { _out += '{'; }
    int Enter(const Shape &shape, std::size_t index)
    {
        if (index != 0)
        {
            _out += ',';
        }
        _out += shape.Parts[index].Quoted;
        return 0;
    }
    void Leave(int) {}
    void EndStruct() { _out += '}'; }
    void BeginUnion(const Shape &shape, std::int64_t label, int place);
    void EndUnion() { _out += '}'; }
    bool Ok() const { return _out.size() <= _maxSize; }

private:
    void Label(const Shape &discriminator, std::int64_t label);

    std::string &_out;
    std::size_t _maxSize;
    bool _isWideText;
};

}  // namespace Rabit::Dynamic
