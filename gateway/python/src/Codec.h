// The Python side of a type: the class of its values, and how they become samples and come from them.
#pragma once

#include <rabit/dynamic/DynamicType.h>
#include <rabit/dynamic/Shape.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace Rabit::Python
{

namespace py = pybind11;

// One shape of a type. Codecs live until the process ends, as the types do. Objects of Python in them are
// never released: the interpreter may be gone by then.
struct Codec
{
    explicit Codec(const Dynamic::Shape &shape) : Shape(shape) {}

    struct Field
    {
        const Dynamic::Part &Part;
        const Codec *Type = nullptr;
        py::handle Name{};  // in Python; a keyword has `_` behind it
        py::handle Slot{};  // of a struct: the descriptor of the class
    };

    const Dynamic::Shape &Shape;
    std::vector<Field> Fields{};       // members of a struct, cases of a union
    const Codec *Element = nullptr;    // of an array or sequence
    py::handle Class{};                // of a struct, union, enum or bitmask
    std::vector<py::handle> Values{};  // of an enum, as Shape.Names

    // The number format of numpy for an array or sequence of these; null: its values are in a list.
    const char *NumberFormat() const;
};

// A message type with its class.
struct MessageClass
{
    std::shared_ptr<const DynamicType> Dynamic;
    const MessageType *Registered = nullptr;  // the same type, perhaps of generated code
    const Codec *Root = nullptr;

    std::string Name() const { return Dynamic->Name(); }
    std::string IdlText() const { return Dynamic->IdlText(); }
};

// The class of a type; made once for each definition. Registers the type. Throws py::value_error if another
// definition of that name is registered.
std::shared_ptr<MessageClass> ClassOf(const std::shared_ptr<const DynamicType> &type);
// The same of a type from a recording: it is not registered, so any number of definitions may have one name.
std::shared_ptr<MessageClass> ClassOfRecorded(const std::shared_ptr<const DynamicType> &type);
// The class of a registered type, also of generated code. Throws py::key_error, with the nearest name.
std::shared_ptr<MessageClass> ClassOf(const std::string &typeName);
// The same of a value or of its class; null: it is no message.
std::shared_ptr<MessageClass> ClassOf(py::handle valueOrClass);
// The codec of a class of a struct, or of a class that is derived from it; null: it is none.
const Codec *CodecOf(PyTypeObject *type);

}  // namespace Rabit::Python
