#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/idl/NearestWord.h>

#include <pybind11/numpy.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "Values.h"

namespace Rabit::Python
{
namespace
{

using Dynamic::CdrBuilder;
using Dynamic::Kind;

std::string Shown(py::handle value)
{
    std::string text = py::cast<std::string>(py::repr(value));
    constexpr std::size_t longest = 60;
    return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

// Writes values; the path names the member that does not fit.
class Writer
{
public:
    Writer(CdrBuilder &out, std::string path) : _out(out), _path(std::move(path)) {}

    void Value(const Codec &codec, py::handle value)
    {
        const Dynamic::Shape &shape = codec.Shape;
        switch (shape.What)
        {
            case Kind::Bool:
                return Bool(value);
            case Kind::Char:
                return Char(value);
            case Kind::Float:
            case Kind::Double:
                return Real(shape, value);
            case Kind::String:
                return Text(shape, value);
            case Kind::Sequence:
            case Kind::Array:
                return List(codec, value);
            case Kind::Enum:
                return _out.Put(Enumerator(codec, value), shape.Size);
            case Kind::Bitmask:
                return Bits(shape, value);
            case Kind::Struct:
                return Struct(codec, value);
            case Kind::Union:
                return Union(codec, value);
            default:
                return Integer(shape, value);
        }
    }

    // The value of a member that is not given.
    void Fresh(const Codec &codec)
    {
        const Dynamic::Shape &shape = codec.Shape;
        switch (shape.What)
        {
            case Kind::String:
                return _out.PutString("");
            case Kind::Sequence:
                return _out.Put(0, 4);
            case Kind::Array:
                for (std::uint32_t i = 0; i < shape.Length; ++i)
                {
                    Fresh(*codec.Element);
                }
                return;
            case Kind::Struct:
                for (const Codec::Field &field : codec.Fields)
                {
                    Fresh(field);
                }
                return;
            case Kind::Union:
                _out.Put(static_cast<std::uint64_t>(shape.Parts.front().Label), shape.Discriminator->Size);
                return Fresh(*codec.Fields.front().Type);
            default:
                _out.Put(shape.Start, shape.Size);
        }
    }

    void Fresh(const Codec::Field &field)
    {
        if (!field.Part.HasDefault)
        {
            Fresh(*field.Type);
        }
        else if (field.Type->Shape.What == Kind::String)
        {
            _out.PutString(field.Part.DefaultText);
        }
        else
        {
            _out.Put(field.Part.DefaultNumber, field.Type->Shape.Size);
        }
    }

private:
    // A step of the path for as long as it lives.
    class Step
    {
    public:
        Step(std::string &path, const std::string &step) : _path(path), _size(path.size()) { _path += step; }
        ~Step() { _path.resize(_size); }
        Step(const Step &) = delete;
        Step &operator=(const Step &) = delete;

    private:
        std::string &_path;
        const std::size_t _size;
    };

    [[noreturn]] void WrongType(const std::string &expected, py::handle value) const
    {
        throw py::type_error(_path + ": expected " + expected + ", not " + Shown(value));
    }
    [[noreturn]] void WrongValue(const std::string &expected, py::handle value) const
    {
        throw py::value_error(_path + ": expected " + expected + ", not " + Shown(value));
    }

    // numpy's boolean is `numpy.bool_` before numpy 2, and `numpy.bool` since.
    static bool IsBool(py::handle value)
    {
        const std::string_view type = Py_TYPE(value.ptr())->tp_name;
        return PyBool_Check(value.ptr()) || type == "numpy.bool" || type == "numpy.bool_";
    }

    void Bool(py::handle value)
    {
        if (!IsBool(value))
        {
            WrongType("True or False", value);
        }
        _out.Put(PyObject_IsTrue(value.ptr()) == 1 ? 1 : 0, 1);
    }

    void Char(py::handle value)
    {
        if (!PyUnicode_Check(value.ptr()) || PyUnicode_GetLength(value.ptr()) != 1 ||
            PyUnicode_ReadChar(value.ptr(), 0) > 0xff)
        {
            WrongType("a str of one character, U+0000 to U+00FF", value);
        }
        _out.Put(PyUnicode_ReadChar(value.ptr(), 0), 1);
    }

    template <class T>
    void Whole(py::handle value, py::handle number)
    {
        constexpr T least = std::numeric_limits<T>::min();
        constexpr T most = std::numeric_limits<T>::max();
        T whole = 0;
        bool fits = false;
        if constexpr (std::is_signed_v<T>)
        {
            const long long wide = PyLong_AsLongLong(number.ptr());
            fits = PyErr_Occurred() == nullptr && wide >= least && wide <= most;
            whole = static_cast<T>(wide);
        }
        else
        {
            const unsigned long long wide = PyLong_AsUnsignedLongLong(number.ptr());
            fits = PyErr_Occurred() == nullptr && wide <= most;
            whole = static_cast<T>(wide);
        }
        PyErr_Clear();
        if (!fits)
        {
            WrongValue("a whole number from " + std::to_string(least) + " to " + std::to_string(most), value);
        }
        _out.Put(static_cast<std::uint64_t>(whole), sizeof(T));
    }

    void Integer(const Dynamic::Shape &shape, py::handle value)
    {
        const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
        if (!number || PyBool_Check(value.ptr()))
        {
            PyErr_Clear();
            WrongType("a whole number", value);
        }
        switch (shape.What)
        {
            case Kind::Int8:
                return Whole<std::int8_t>(value, number);
            case Kind::Int16:
                return Whole<std::int16_t>(value, number);
            case Kind::Uint16:
                return Whole<std::uint16_t>(value, number);
            case Kind::Int32:
                return Whole<std::int32_t>(value, number);
            case Kind::Uint32:
                return Whole<std::uint32_t>(value, number);
            case Kind::Int64:
                return Whole<std::int64_t>(value, number);
            case Kind::Uint64:
                return Whole<std::uint64_t>(value, number);
            default:
                return Whole<std::uint8_t>(value, number);
        }
    }

    void Real(const Dynamic::Shape &shape, py::handle value)
    {
        const double number = PyFloat_AsDouble(value.ptr());
        if (PyErr_Occurred() != nullptr || PyBool_Check(value.ptr()))
        {
            PyErr_Clear();
            WrongType("a number", value);
        }
        if (shape.What == Kind::Double)
        {
            return _out.Put(std::bit_cast<std::uint64_t>(number), 8);
        }
        const auto single = static_cast<float>(number);
        if (std::isinf(single) && !std::isinf(number))
        {
            WrongValue("a number that a float can hold, up to 3.4028235e+38", value);
        }
        _out.Put(std::bit_cast<std::uint32_t>(single), 4);
    }

    void Text(const Dynamic::Shape &shape, py::handle value)
    {
        if (!PyUnicode_Check(value.ptr()))
        {
            WrongType("a str", value);
        }
        const auto bytes = py::reinterpret_steal<py::object>(
            PyUnicode_AsEncodedString(value.ptr(), "utf-8", "surrogateescape"));
        if (!bytes)
        {
            PyErr_Clear();
            WrongValue("a str that UTF-8 can express", value);
        }
        const std::string_view text(PyBytes_AS_STRING(bytes.ptr()),
                                    static_cast<std::size_t>(PyBytes_GET_SIZE(bytes.ptr())));
        if (text.find('\0') != std::string_view::npos)
        {
            WrongValue("a str without the character U+0000", value);
        }
        Length(shape, text.size(), "bytes");
        _out.PutString(text);
    }

    void Length(const Dynamic::Shape &shape, std::size_t length, const std::string &what) const
    {
        if (shape.What == Kind::Array && length != shape.Length)
        {
            throw py::value_error(_path + ": expected " + std::to_string(shape.Length) + " " + what +
                                  ", not " + std::to_string(length));
        }
        if (shape.Bound != 0 && length > shape.Bound)
        {
            throw py::value_error(_path + ": expected at most " + std::to_string(shape.Bound) + " " + what +
                                  ", not " + std::to_string(length));
        }
    }

    void List(const Codec &codec, py::handle value)
    {
        if (PyUnicode_Check(value.ptr()))
        {
            WrongType("a list", value);
        }
        if (codec.Element->NumberFormat() != nullptr && Numbers(codec, value))
        {
            return;
        }
        // A tuple of its own: elements may run code of Python, which may change the list.
        const auto items = py::reinterpret_steal<py::tuple>(PySequence_Tuple(value.ptr()));
        if (!items)
        {
            PyErr_Clear();
            WrongType("a list", value);
        }
        const std::size_t length = items.size();
        Length(codec.Shape, length, "elements");
        if (codec.Shape.What == Kind::Sequence)
        {
            _out.Put(length, 4);
        }
        for (std::size_t i = 0; i < length; ++i)
        {
            const Step step(_path, "[" + std::to_string(i) + "]");
            Value(*codec.Element, PyTuple_GET_ITEM(items.ptr(), static_cast<Py_ssize_t>(i)));
        }
    }

    // Copies an array of numpy, or any other buffer, of exactly these numbers. False: it is another thing,
    // and its elements are to be looked at.
    bool Numbers(const Codec &codec, py::handle value)
    {
        std::vector<std::size_t> dimensions;
        const Codec *number = codec.Element;
        for (; number->Shape.What == Kind::Array; number = number->Element)
        {
            dimensions.push_back(number->Shape.Length);
        }
        if (!PyObject_CheckBuffer(value.ptr()))
        {
            return false;
        }
        const py::array array = py::array::ensure(value);
        if (!array || array.ndim() != static_cast<py::ssize_t>(1 + dimensions.size()) ||
            !array.dtype().is(py::dtype(std::string(number->NumberFormat()))) ||
            (array.flags() & py::array::c_style) == 0)
        {
            PyErr_Clear();
            return false;
        }
        for (std::size_t i = 0; i < dimensions.size(); ++i)
        {
            if (array.shape(static_cast<py::ssize_t>(i + 1)) != static_cast<py::ssize_t>(dimensions[i]))
            {
                return false;
            }
        }
        Length(codec.Shape, static_cast<std::size_t>(array.shape(0)), "elements");
        if (codec.Shape.What == Kind::Sequence)
        {
            _out.Put(static_cast<std::uint64_t>(array.shape(0)), 4);
        }
        if (array.size() > 0)
        {
            _out.Align(number->Shape.Size);
            _out.PutBytes(
                {static_cast<const std::uint8_t *>(array.data()), static_cast<std::size_t>(array.nbytes())});
        }
        return true;
    }

    std::uint64_t Enumerator(const Codec &codec, py::handle value) const
    {
        const Dynamic::Shape &shape = codec.Shape;
        for (std::size_t i = 0; i < codec.Values.size(); ++i)
        {
            if (codec.Values[i].is(value))
            {
                return shape.Names[i].Number;
            }
        }
        std::vector<std::string> names;
        for (const Dynamic::NamedNumber &name : shape.Names)
        {
            names.push_back(name.Name);
        }
        if (PyUnicode_Check(value.ptr()))
        {
            const auto word = py::cast<std::string>(value);
            for (const Dynamic::NamedNumber &name : shape.Names)
            {
                if (name.Name == word)
                {
                    return name.Number;
                }
            }
            throw py::value_error(_path + ": no value of " + shape.Name + " is named `" + word + "`" +
                                  NearestWordHint(word, names));
        }
        const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
        const std::uint64_t whole = number ? PyLong_AsUnsignedLongLong(number.ptr()) : 0;
        const bool isNumber = PyErr_Occurred() == nullptr && !PyBool_Check(value.ptr());
        PyErr_Clear();
        if (!isNumber || EnumeratorOf(shape, whole) == nullptr)
        {
            WrongType("a value of " + shape.Name, value);
        }
        return whole;
    }

    void Bits(const Dynamic::Shape &shape, py::handle value)
    {
        const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
        const std::uint64_t mask = number ? PyLong_AsUnsignedLongLong(number.ptr()) : 0;
        const bool isNumber = PyErr_Occurred() == nullptr && !PyBool_Check(value.ptr());
        PyErr_Clear();
        if (!isNumber || (mask & ~shape.AllBits) != 0)
        {
            WrongType("bits of " + shape.Name, value);
        }
        _out.Put(mask, shape.Size);
    }

    void Struct(const Codec &codec, py::handle value)
    {
        if (CodecOf(Py_TYPE(value.ptr())) == &codec)
        {
            for (const Codec::Field &field : codec.Fields)
            {
                const Step step(_path, "." + field.Part.Name);
                const auto member =
                    py::reinterpret_steal<py::object>(PyObject_GetAttr(value.ptr(), field.Name.ptr()));
                if (!member)
                {
                    throw py::error_already_set();
                }
                Value(*field.Type, member);
            }
            return;
        }
        if (!PyDict_Check(value.ptr()))
        {
            WrongType("a " + codec.Shape.Name, value);
        }
        std::size_t used = 0;
        for (const Codec::Field &field : codec.Fields)
        {
            const Step step(_path, "." + field.Part.Name);
            const auto member =
                py::reinterpret_borrow<py::object>(PyDict_GetItem(value.ptr(), field.Name.ptr()));
            used += member ? 1 : 0;
            member ? Value(*field.Type, member) : Fresh(field);
        }
        if (used != py::len(value))
        {
            RefuseOthers(codec, py::reinterpret_borrow<py::dict>(value));
        }
    }

    void RefuseOthers(const Codec &codec, const py::dict &named) const
    {
        std::vector<std::string> names;
        for (const Codec::Field &field : codec.Fields)
        {
            names.push_back(py::cast<std::string>(field.Name));
        }
        for (const auto &[name, value] : named)
        {
            const auto word = py::cast<std::string>(py::str(name));
            if (std::find(names.begin(), names.end(), word) == names.end())
            {
                throw py::type_error(_path + " has no member `" + word + "`" + NearestWordHint(word, names));
            }
        }
    }

    void Union(const Codec &codec, py::handle value)
    {
        if (CodecOf(Py_TYPE(value.ptr())) != &codec)
        {
            WrongType("a " + codec.Shape.Name, value);
        }
        const py::object name = value.attr("case");
        const auto label = py::cast<std::int64_t>(value.attr("_label"));
        _out.Put(static_cast<std::uint64_t>(label), codec.Shape.Discriminator->Size);
        for (const Codec::Field &field : codec.Fields)
        {
            if (!name.is_none() && name.equal(field.Name))
            {
                const Step step(_path, "." + field.Part.Name);
                Value(*field.Type, value.attr("value"));
            }
        }
    }

    CdrBuilder &_out;
    std::string _path;
};

}  // namespace

std::vector<std::uint8_t> Encode(const Codec &codec, py::handle value, const std::string &path)
{
    CdrBuilder out;
    Writer(out, path).Value(codec, value);
    return out.Finish();
}

std::vector<std::uint8_t> Encode(const Codec &codec, py::handle value)
{
    return Encode(codec, value, codec.Shape.Name);
}

std::vector<std::uint8_t> EncodeDefault(const Codec::Field &field)
{
    CdrBuilder out;
    Writer(out, "").Fresh(field);
    return out.Finish();
}

void Assign(const MessageClass &type, std::span<const std::uint8_t> sample, RabitMessage &message)
{
    if (!type.Registered->Deserialize(sample, message))
    {
        throw py::value_error(type.Name() + ": the value is too large");
    }
}

std::shared_ptr<RabitMessage> MessageOf(const MessageClass &type, py::handle value)
{
    std::shared_ptr<RabitMessage> message = type.Registered->CreateShared();
    Assign(type, Encode(*type.Root, value), *message);
    return message;
}

}  // namespace Rabit::Python
