#include "Codec.h"

#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/NearestWord.h>

#include <deque>
#include <map>
#include <unordered_map>

namespace Rabit::Python
{
namespace
{

using Dynamic::Kind;

// All that is guarded by the GIL, and lives until the process ends.
struct Known
{
    std::deque<Codec> Codecs;
    std::map<std::string, const Codec *> Definitions;  // by signature
    std::unordered_map<PyTypeObject *, const Codec *> ByClass;
    std::unordered_map<const Codec *, std::shared_ptr<MessageClass>> Messages;
    std::vector<std::shared_ptr<const DynamicType>> Kept;
};

Known &Everything()
{
    static auto &known = *new Known;
    return known;
}

// Tells definitions of one name apart: two types may have been built with two versions of it.
std::string SignatureOf(const Dynamic::Shape &shape)
{
    std::string text = std::to_string(static_cast<int>(shape.What)) + "," + std::to_string(shape.Size) + "," +
                       std::to_string(shape.Bound) + "," + std::to_string(shape.Length) + " " + shape.Name;
    if (shape.Element != nullptr)
    {
        text += "<" + SignatureOf(*shape.Element) + ">";
    }
    for (const Dynamic::NamedNumber &name : shape.Names)
    {
        text += " " + name.Name + "=" + std::to_string(name.Number);
    }
    for (const auto &[label, place] : shape.Labels)
    {
        text += " " + std::to_string(label) + ":" + std::to_string(place);
    }
    if (shape.Discriminator != nullptr)
    {
        text += " (" + SignatureOf(*shape.Discriminator) + ")";
    }
    text += "{";
    for (const Dynamic::Part &part : shape.Parts)
    {
        text += part.Name + "=" + std::to_string(part.DefaultNumber) + part.DefaultText + " " +
                SignatureOf(*part.Type) + ";";
    }
    return text + "}";
}

bool IsDefinition(Kind kind)
{
    return kind == Kind::Struct || kind == Kind::Union || kind == Kind::Enum || kind == Kind::Bitmask;
}

// Makes the class of a definition, in Python.
void MakeClass(Codec &codec)
{
    const auto classes = py::module_::import("rabit._messages");
    py::list names;
    py::list values;
    for (const Dynamic::NamedNumber &name : codec.Shape.Names)
    {
        names.append(py::make_tuple(name.Name, name.Number));
    }
    for (Codec::Field &field : codec.Fields)
    {
        const py::object name = classes.attr("python_name")(field.Part.Name);
        field.Name =
            py::reinterpret_steal<py::object>(PyUnicode_InternFromString(py::cast<std::string>(name).c_str()))
                .release();
        names.append(field.Name);
    }
    const char *maker = codec.Shape.What == Kind::Struct  ? "make_struct"
                        : codec.Shape.What == Kind::Union ? "make_union"
                        : codec.Shape.What == Kind::Enum  ? "make_enum"
                                                          : "make_bitmask";
    codec.Class = py::object(classes.attr(maker)(codec.Shape.Name, names)).release();
    if (codec.Shape.What == Kind::Struct)
    {
        for (Codec::Field &field : codec.Fields)
        {
            field.Slot = py::object(codec.Class.attr("__dict__")[field.Name]).release();
        }
    }
    if (codec.Shape.What == Kind::Enum)
    {
        for (const Dynamic::NamedNumber &name : codec.Shape.Names)
        {
            codec.Values.push_back(py::object(codec.Class.attr("__members__")[py::str(name.Name)]).release());
        }
    }
    Everything().ByClass.emplace(reinterpret_cast<PyTypeObject *>(codec.Class.ptr()), &codec);
}

const Codec *CodecFor(const Dynamic::Shape &shape)
{
    Known &known = Everything();
    const std::string signature = SignatureOf(shape);
    const auto found = known.Definitions.find(signature);
    if (found != known.Definitions.end())
    {
        return found->second;
    }
    Codec made(shape);
    made.Element = shape.Element == nullptr ? nullptr : CodecFor(*shape.Element);
    for (const Dynamic::Part &part : shape.Parts)
    {
        made.Fields.push_back({part, CodecFor(*part.Type)});
    }
    Codec &codec = known.Codecs.emplace_back(std::move(made));
    if (IsDefinition(shape.What))
    {
        MakeClass(codec);
    }
    known.Definitions.emplace(signature, &codec);
    return &codec;
}

}  // namespace

const char *Codec::NumberFormat() const
{
    switch (Shape.What)
    {
        case Kind::Octet:
        case Kind::Uint8:
            return "u1";
        case Kind::Int8:
            return "i1";
        case Kind::Int16:
            return "i2";
        case Kind::Uint16:
            return "u2";
        case Kind::Int32:
            return "i4";
        case Kind::Uint32:
            return "u4";
        case Kind::Int64:
            return "i8";
        case Kind::Uint64:
            return "u8";
        case Kind::Float:
            return "f4";
        case Kind::Double:
            return "f8";
        case Kind::Array:
            return Element->NumberFormat();
        default:
            return nullptr;
    }
}

std::shared_ptr<MessageClass> ClassOf(const std::shared_ptr<const DynamicType> &type)
{
    const MessageType *registered = DynamicType::Register(type);
    if (registered == nullptr)
    {
        throw py::value_error("another definition of " + type->Name() +
                              " is in use in this process; a name has one definition until the process ends");
    }
    const auto message = ClassOfRecorded(type);
    message->Registered = registered;
    return message;
}

std::shared_ptr<MessageClass> ClassOfRecorded(const std::shared_ptr<const DynamicType> &type)
{
    Known &known = Everything();
    const Codec *codec = CodecFor(type->Root());
    auto &message = known.Messages[codec];
    if (!message)
    {
        message = std::make_shared<MessageClass>(MessageClass{type, type.get(), codec});
        known.Kept.push_back(type);
    }
    return message;
}

std::shared_ptr<MessageClass> ClassOf(const std::string &typeName)
{
    const MessageType *type = MessageTypeRegistry::Find(typeName);
    if (type == nullptr)
    {
        throw py::key_error("no type `" + typeName + "` is known here" +
                            NearestWordHint(typeName, MessageTypeRegistry::Names()));
    }
    for (const auto &[codec, message] : Everything().Messages)
    {
        if (message->Registered == type)
        {
            return message;
        }
    }
    const ParsedType parsed = DynamicType::Parse(type->IdlText(), typeName);
    if (!parsed.Type)
    {
        throw py::value_error(typeName + ": " + parsed.Reason);
    }
    return ClassOf(parsed.Type);
}

const Codec *CodecOf(PyTypeObject *type)
{
    const auto &known = Everything().ByClass;
    for (; type != nullptr; type = type->tp_base)
    {
        const auto found = known.find(type);
        if (found != known.end())
        {
            return found->second;
        }
    }
    return nullptr;
}

std::shared_ptr<MessageClass> ClassOf(py::handle valueOrClass)
{
    PyTypeObject *type = PyType_Check(valueOrClass.ptr())
                             ? reinterpret_cast<PyTypeObject *>(valueOrClass.ptr())
                             : Py_TYPE(valueOrClass.ptr());
    const Codec *codec = CodecOf(type);
    const auto found = Everything().Messages.find(codec);
    return found == Everything().Messages.end() ? nullptr : found->second;
}

}  // namespace Rabit::Python
