// Reads a value from bytes by its shape, by the rules of generated code (idl/runtime's Shapes.h), and
// passes its parts to a sink. Bytes are checked here, so all sinks refuse the same ones.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <rabit/idl/CdrReader.h>
#include <rabit/idl/GeneratedMessageType.h>

#include <fastcdr/exceptions/Exception.h>

#include <new>
#include <span>
#include <stdexcept>
#include <string_view>

namespace Rabit::Dynamic
{

// A sink has these functions, in the order of the calls:
//   Bool, Char, Number (std::uint8_t to std::int64_t, float, double), Text
//   Enumerator(shape, enumerator), Bits(shape, mask)
//   Octets(span)                      an array or sequence of octets, whole
//   BeginList(count), Element(index) before each, EndList
//   BeginStruct, saved = Enter(shape, index) before each member and Leave(saved) behind it, EndStruct
//   BeginUnion(shape, label, place), EndUnion
// Element and Enter are followed by Ok(): false stops the walk, which then fails.
template <class Sink>
class Walk
{
public:
    Walk(Idl::CdrReader &reader, Sink &sink) : _reader(reader), _sink(sink) {}

    // False if the bytes are no value of that shape, or the sink is not Ok.
    bool Value(const Shape &shape)
    {
        switch (shape.What)
        {
            case Kind::Bool:
            {
                bool value = false;
                if (!_reader.GetBool(value))
                {
                    return false;
                }
                _sink.Bool(value);
                return true;
            }
            case Kind::Char:
            {
                char value = 0;
                if (!_reader.Get(value))
                {
                    return false;
                }
                _sink.Char(value);
                return true;
            }
            case Kind::Octet:
            case Kind::Uint8:
                return Number<std::uint8_t>();
            case Kind::Int8:
                return Number<std::int8_t>();
            case Kind::Int16:
                return Number<std::int16_t>();
            case Kind::Uint16:
                return Number<std::uint16_t>();
            case Kind::Int32:
                return Number<std::int32_t>();
            case Kind::Uint32:
                return Number<std::uint32_t>();
            case Kind::Int64:
                return Number<std::int64_t>();
            case Kind::Uint64:
                return Number<std::uint64_t>();
            case Kind::Float:
                return Number<float>();
            case Kind::Double:
                return Number<double>();
            case Kind::String:
            {
                std::string_view text;
                if (!_reader.GetString(shape.Bound, text))
                {
                    return false;
                }
                _sink.Text(text);
                return true;
            }
            case Kind::Sequence:
            {
                std::size_t length = 0;
                return _reader.GetLength(shape.Bound, shape.Element->MinSize, length) &&
                       List(*shape.Element, length, true);
            }
            case Kind::Array:
                return List(*shape.Element, shape.Length, false);
            case Kind::Enum:
            {
                std::uint64_t value = 0;
                if (!Unsigned(shape.Size, value))
                {
                    return false;
                }
                const NamedNumber *enumerator = EnumeratorOf(shape, value);
                if (enumerator == nullptr)
                {
                    return false;
                }
                _sink.Enumerator(shape, *enumerator);
                return true;
            }
            case Kind::Bitmask:
            {
                std::uint64_t value = 0;
                if (!Unsigned(shape.Size, value) || (value & ~shape.AllBits) != 0)
                {
                    return false;
                }
                _sink.Bits(shape, value);
                return true;
            }
            case Kind::Struct:
                return Struct(shape);
            case Kind::Union:
                return Union(shape);
        }
        return false;
    }

private:
    template <class T>
    bool Number()
    {
        T value{};
        if (!_reader.Get(value))
        {
            return false;
        }
        _sink.Number(value);
        return true;
    }

    template <class T>
    bool Widened(std::uint64_t &value)
    {
        T narrow{};
        if (!_reader.Get(narrow))
        {
            return false;
        }
        value = static_cast<std::uint64_t>(narrow);
        return true;
    }

    bool Unsigned(unsigned size, std::uint64_t &value)
    {
        switch (size)
        {
            case 1:
                return Widened<std::uint8_t>(value);
            case 2:
                return Widened<std::uint16_t>(value);
            case 4:
                return Widened<std::uint32_t>(value);
            default:
                return Widened<std::uint64_t>(value);
        }
    }

    // Reads a discriminator as the labels of a union are stored: signed types sign-extended, all others
    // zero-extended.
    bool Label(const Shape &shape, std::int64_t &label)
    {
        std::uint64_t value = 0;
        bool good = false;
        switch (shape.What)
        {
            case Kind::Bool:
            {
                bool flag = false;
                good = _reader.GetBool(flag);
                value = flag ? 1 : 0;
                break;
            }
            case Kind::Char:
                good = Widened<char>(value);
                break;
            case Kind::Int8:
                good = Widened<std::int8_t>(value);
                break;
            case Kind::Int16:
                good = Widened<std::int16_t>(value);
                break;
            case Kind::Int32:
                good = Widened<std::int32_t>(value);
                break;
            case Kind::Enum:
                good = Unsigned(shape.Size, value) && EnumeratorOf(shape, value) != nullptr;
                break;
            default:
                good = Unsigned(shape.Size, value);
        }
        label = static_cast<std::int64_t>(value);
        return good;
    }

    bool List(const Shape &element, std::size_t count, bool isSequence)
    {
        if (element.What == Kind::Octet)
        {
            std::span<const std::uint8_t> bytes;
            if (!_reader.GetBytes(count, bytes))
            {
                return false;
            }
            _sink.Octets(bytes, isSequence);
            return _sink.Ok();
        }
        if (element.MinSize > _reader.Left() && count != 0)
        {
            return false;
        }
        _sink.BeginList(count, isSequence);
        for (std::size_t i = 0; i < count; ++i)
        {
            _sink.Element(i);
            if (!_sink.Ok() || !Value(element))
            {
                return false;
            }
        }
        _sink.EndList();
        return true;
    }

    bool Struct(const Shape &shape)
    {
        _sink.BeginStruct();
        for (std::size_t i = 0; i < shape.Parts.size(); ++i)
        {
            const auto saved = _sink.Enter(shape, i);
            if (!_sink.Ok() || !Value(*shape.Parts[i].Type))
            {
                return false;
            }
            _sink.Leave(saved);
        }
        _sink.EndStruct();
        return true;
    }

    bool Union(const Shape &shape)
    {
        std::int64_t label = 0;
        if (!Label(*shape.Discriminator, label))
        {
            return false;
        }
        const int place = CaseOf(shape, label);
        if (place == NotAllowed)
        {
            return false;
        }
        _sink.BeginUnion(shape, label, place);
        if (!_sink.Ok() || (place != NoCase && !Value(*shape.Parts[static_cast<std::size_t>(place)].Type)))
        {
            return false;
        }
        _sink.EndUnion();
        return true;
    }

    Idl::CdrReader &_reader;
    Sink &_sink;
};

// Walks over a whole sample. False if it is refused.
template <class Sink>
bool WalkSample(const Shape &shape, std::span<const std::uint8_t> sample, Sink &sink)
{
    std::span<const std::uint8_t> body;
    bool littleEndian = true;
    if (!Idl::OpenSample(sample, body, littleEndian))
    {
        return false;
    }
    try
    {
        Idl::CdrReader reader(body, littleEndian);
        return Walk<Sink>(reader, sink).Value(shape) && reader.Left() <= Idl::MaxPadding && sink.Ok();
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
    catch (const std::bad_alloc &)
    {
        return false;
    }
    catch (const std::length_error &)
    {
        return false;
    }
}

}  // namespace Rabit::Dynamic
