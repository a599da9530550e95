#include <rabit/dynamic/DynamicMessage.h>

#include <pybind11/numpy.h>

#include <cstring>

#include "Values.h"

namespace Rabit::Python
{
namespace
{

using Dynamic::Kind;

// A sample whose bytes were checked before: it is in normal form.
class Reader
{
public:
    explicit Reader(std::span<const std::uint8_t> sample) : _body(sample.subspan(Idl::EncapsulationSize)) {}

    py::object Value(const Codec &codec)
    {
        const Dynamic::Shape &shape = codec.Shape;
        switch (shape.What)
        {
            case Kind::Bool:
                return py::bool_(Take<std::uint8_t>() != 0);
            case Kind::Char:
            {
                const auto letter = static_cast<Py_UCS4>(Take<std::uint8_t>());
                return py::reinterpret_steal<py::object>(
                    PyUnicode_FromKindAndData(PyUnicode_4BYTE_KIND, &letter, 1));
            }
            case Kind::Octet:
            case Kind::Uint8:
                return py::int_(Take<std::uint8_t>());
            case Kind::Int8:
                return py::int_(Take<std::int8_t>());
            case Kind::Int16:
                return py::int_(Take<std::int16_t>());
            case Kind::Uint16:
                return py::int_(Take<std::uint16_t>());
            case Kind::Int32:
                return py::int_(Take<std::int32_t>());
            case Kind::Uint32:
                return py::int_(Take<std::uint32_t>());
            case Kind::Int64:
                return py::int_(Take<std::int64_t>());
            case Kind::Uint64:
                return py::int_(Take<std::uint64_t>());
            case Kind::Float:
                return py::float_(static_cast<double>(Take<float>()));
            case Kind::Double:
                return py::float_(Take<double>());
            case Kind::String:
                return Text();
            case Kind::Sequence:
                return List(*codec.Element, Take<std::uint32_t>());
            case Kind::Array:
                return List(*codec.Element, shape.Length);
            case Kind::Enum:
                return Enumerator(codec, Unsigned(shape.Size));
            case Kind::Bitmask:
                return py::reinterpret_borrow<py::object>(codec.Class)(Unsigned(shape.Size));
            case Kind::Struct:
                return Struct(codec);
            case Kind::Union:
                return Union(codec);
        }
        throw std::logic_error("a value of an unknown kind");
    }

private:
    const std::uint8_t *Take(std::size_t size, std::size_t alignment)
    {
        _at = (_at + alignment - 1) / alignment * alignment;
        if (_at > _body.size() || size > _body.size() - _at)
        {
            throw std::logic_error("a sample that was not checked");
        }
        const std::uint8_t *bytes = _body.data() + _at;
        _at += size;
        return bytes;
    }

    template <class T>
    T Take()
    {
        T value;
        std::memcpy(&value, Take(sizeof value, sizeof value), sizeof value);
        return value;
    }

    std::uint64_t Unsigned(unsigned size)
    {
        std::uint64_t value = 0;
        std::memcpy(&value, Take(size, size), size);
        return value;
    }

    std::int64_t Signed(const Dynamic::Shape &shape)
    {
        switch (shape.What)
        {
            case Kind::Char:
            case Kind::Int8:
                return Take<std::int8_t>();
            case Kind::Int16:
                return Take<std::int16_t>();
            case Kind::Int32:
                return Take<std::int32_t>();
            default:
                return static_cast<std::int64_t>(Unsigned(shape.Size));
        }
    }

    py::object Text()
    {
        const auto size = Take<std::uint32_t>();
        const auto *text = reinterpret_cast<const char *>(Take(size, 1));
        // A string that is not UTF-8 keeps its bytes, as file names do in Python.
        return py::reinterpret_steal<py::object>(
            PyUnicode_DecodeUTF8(text, static_cast<Py_ssize_t>(size) - 1, "surrogateescape"));
    }

    static py::object Enumerator(const Codec &codec, std::uint64_t value)
    {
        const Dynamic::NamedNumber *named = EnumeratorOf(codec.Shape, value);
        const auto place = static_cast<std::size_t>(named - codec.Shape.Names.data());
        return py::reinterpret_borrow<py::object>(codec.Values.at(place));
    }

    py::object List(const Codec &element, std::size_t count)
    {
        if (element.NumberFormat() != nullptr)
        {
            return Numbers(element, count);
        }
        py::list list(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            PyList_SET_ITEM(list.ptr(), static_cast<Py_ssize_t>(i), Value(element).release().ptr());
        }
        return list;
    }

    py::object Numbers(const Codec &element, std::size_t count)
    {
        std::vector<py::ssize_t> dimensions{static_cast<py::ssize_t>(count)};
        const Codec *number = &element;
        std::size_t total = count;
        for (; number->Shape.What == Kind::Array; number = number->Element)
        {
            dimensions.push_back(static_cast<py::ssize_t>(number->Shape.Length));
            total *= number->Shape.Length;
        }
        const py::dtype type(std::string(number->NumberFormat()));
        if (total == 0)
        {
            return py::array(type, dimensions);
        }
        const std::size_t size = number->Shape.Size;
        const std::uint8_t *bytes = Take(size * total, size);
        return py::array(type, dimensions, Copy() + (bytes - _body.data()), _owner);
    }

    // The body of the sample in memory that lives as long as the arrays, aligned for them.
    const std::uint8_t *Copy()
    {
        if (!_owner)
        {
            auto *words = new std::vector<std::uint64_t>((_body.size() + 7) / 8);
            std::memcpy(words->data(), _body.data(), _body.size());
            _owner =
                py::capsule(words, [](void *all) { delete static_cast<std::vector<std::uint64_t> *>(all); });
            _copy = reinterpret_cast<const std::uint8_t *>(words->data());
        }
        return _copy;
    }

    py::object Struct(const Codec &codec)
    {
        auto *type = reinterpret_cast<PyTypeObject *>(codec.Class.ptr());
        auto value = py::reinterpret_steal<py::object>(type->tp_alloc(type, 0));
        if (!value)
        {
            throw py::error_already_set();
        }
        for (const Codec::Field &field : codec.Fields)
        {
            const py::object member = Value(*field.Type);
            Py_TYPE(field.Slot.ptr())->tp_descr_set(field.Slot.ptr(), value.ptr(), member.ptr());
        }
        return value;
    }

    py::object Union(const Codec &codec)
    {
        const std::int64_t label = Signed(*codec.Shape.Discriminator);
        const int place = CaseOf(codec.Shape, label);
        const py::object make = codec.Class.attr("_of");
        if (place < 0)
        {
            return make(py::none(), py::none(), label);
        }
        const Codec::Field &field = codec.Fields[static_cast<std::size_t>(place)];
        return make(field.Name, Value(*field.Type), label);
    }

    const std::span<const std::uint8_t> _body;
    std::size_t _at = 0;
    py::object _owner;
    const std::uint8_t *_copy = nullptr;
};

}  // namespace

py::object Decode(const Codec &codec, std::span<const std::uint8_t> sample)
{
    return Reader(sample).Value(codec);
}

py::object ValueOf(const MessageClass &type, const RabitMessage &message)
{
    if (const auto *dynamic = dynamic_cast<const DynamicMessage *>(&message))
    {
        return Decode(*type.Root, dynamic->Sample());
    }
    std::vector<std::uint8_t> sample(type.Registered->SerializedSize(message));
    if (type.Registered->Serialize(message, sample) == 0)
    {
        throw py::value_error(type.Name() + ": the message does not fit its IDL type");
    }
    return Decode(*type.Root, sample);
}

py::object ValueOfBytes(const MessageClass &type, std::span<const std::uint8_t> bytes)
{
    const auto sample = type.Dynamic->Normalized(bytes);
    if (!sample)
    {
        throw py::value_error("not a sample of " + type.Name());
    }
    return Decode(*type.Root, *sample);
}

}  // namespace Rabit::Python
