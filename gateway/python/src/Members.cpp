// The members of a value of Python: set at its construction, and later.
#include <rabit/idl/NearestWord.h>

#include "Values.h"

namespace Rabit::Python
{
namespace
{

using Dynamic::Kind;

const Codec &CodecOrThrow(py::handle self)
{
    const Codec *codec = CodecOf(Py_TYPE(self.ptr()));
    if (codec == nullptr)
    {
        throw py::type_error("not a class of an IDL type");
    }
    return *codec;
}

void Store(py::handle self, const Codec::Field &field, const py::object &member)
{
    if (Py_TYPE(field.Slot.ptr())->tp_descr_set(field.Slot.ptr(), self.ptr(), member.ptr()) != 0)
    {
        throw py::error_already_set();
    }
}

py::object FreshOf(const Codec::Field &field)
{
    return Decode(*field.Type, EncodeDefault(field));
}

// The value as the member keeps it.
py::object Converted(const Codec &owner, const Codec::Field &field, py::handle value)
{
    const std::vector<std::uint8_t> sample =
        Encode(*field.Type, value, owner.Shape.Name + "." + field.Part.Name);
    const Kind kind = field.Type->Shape.What;
    const bool stays = (kind == Kind::Struct && !PyDict_Check(value.ptr())) || kind == Kind::Union ||
                       (kind == Kind::Double && PyFloat_CheckExact(value.ptr())) ||
                       (kind == Kind::String && PyUnicode_CheckExact(value.ptr()));
    return stays ? py::reinterpret_borrow<py::object>(value) : Decode(*field.Type, sample);
}

const Codec::Field &FieldOrThrow(const Codec &codec, py::handle name)
{
    std::vector<std::string> names;
    for (const Codec::Field &field : codec.Fields)
    {
        if (field.Name.is(name) || field.Name.equal(name))
        {
            return field;
        }
        names.push_back(py::cast<std::string>(field.Name));
    }
    const auto word = py::cast<std::string>(name);
    throw py::attribute_error(codec.Shape.Name + " has no member `" + word + "`" +
                              NearestWordHint(word, names));
}

}  // namespace

void Init(py::handle self, const py::tuple &given, const py::dict &named)
{
    const Codec &codec = CodecOrThrow(self);
    if (given.size() > codec.Fields.size())
    {
        throw py::type_error(codec.Shape.Name + " has " + std::to_string(codec.Fields.size()) +
                             " members, not " + std::to_string(given.size()));
    }
    for (std::size_t i = 0; i < codec.Fields.size(); ++i)
    {
        const Codec::Field &field = codec.Fields[i];
        if (i < given.size())
        {
            Store(self, field, Converted(codec, field, given[i]));
        }
        else if (!named.contains(field.Name))
        {
            Store(self, field, FreshOf(field));
        }
    }
    for (const auto &[name, value] : named)
    {
        const Codec::Field *field = nullptr;
        try
        {
            field = &FieldOrThrow(codec, name);
        }
        catch (const py::attribute_error &error)
        {
            throw py::type_error(error.what());
        }
        if (static_cast<std::size_t>(field - codec.Fields.data()) < given.size())
        {
            throw py::type_error(codec.Shape.Name + "." + field->Part.Name + " is given twice");
        }
        Store(self, *field, Converted(codec, *field, value));
    }
}

void SetMember(py::handle self, py::handle name, py::handle value)
{
    const Codec &codec = CodecOrThrow(self);
    const Codec::Field &field = FieldOrThrow(codec, name);
    Store(self, field, Converted(codec, field, value));
}

}  // namespace Rabit::Python
