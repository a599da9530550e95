#include <rabit/dynamic/IdlFile.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/NearestWord.h>

#include <pybind11/stl.h>

#include "Module.h"
#include "Values.h"

namespace Rabit::Python
{
namespace
{

py::tuple LoadIdl(const std::string &path, const std::vector<std::string> &folders)
{
    const IdlFile file = IdlFile::Load(path, folders);
    if (!file.Reason.empty())
    {
        throw py::value_error(file.Reason);
    }
    std::vector<std::shared_ptr<MessageClass>> messages;
    for (const auto &type : file.Messages)
    {
        messages.push_back(ClassOf(type));
    }
    return py::make_tuple(messages, file.Constants, file.Comments);
}

std::shared_ptr<MessageClass> Parse(const std::string &text, const std::string &name)
{
    const ParsedType parsed = DynamicType::Parse(text, name);
    if (!parsed.Type)
    {
        throw py::value_error(name + ": " + parsed.Reason);
    }
    return ClassOf(parsed.Type);
}

std::span<const std::uint8_t> BytesOf(const py::bytes &bytes)
{
    const auto view = static_cast<std::string_view>(bytes);
    return {reinterpret_cast<const std::uint8_t *>(view.data()), view.size()};
}

const MessageClass &OfValue(py::handle value)
{
    const auto type = ClassOf(value);
    if (!type)
    {
        throw py::type_error("expected a message, not " + py::cast<std::string>(py::repr(value)));
    }
    return *type;
}

// The members of a class, for stubs: name, and a description of the type as a tuple.
py::object Described(const Codec &codec)
{
    using Dynamic::Kind;
    if (codec.Class)
    {
        return py::reinterpret_borrow<py::object>(codec.Class);
    }
    if (const char *format = codec.NumberFormat(); format != nullptr && codec.Element == nullptr)
    {
        return py::str(format);
    }
    switch (codec.Shape.What)
    {
        case Kind::Bool:
            return py::str("bool");
        case Kind::Char:
        case Kind::String:
            return py::str("str");
        default:
            return py::make_tuple(codec.Element->NumberFormat() != nullptr, Described(*codec.Element));
    }
}

}  // namespace

void DefineMessages(py::module_ &module)
{
    py::class_<MessageClass, std::shared_ptr<MessageClass>>(module, "Type")
        .def_property_readonly("name", &MessageClass::Name)
        .def_property_readonly("idl_text", &MessageClass::IdlText)
        .def_property_readonly("cls", [](const MessageClass &type)
                               { return py::reinterpret_borrow<py::object>(type.Root->Class); });
    module.def("load_idl", &LoadIdl);
    module.def("parse_idl", &Parse);
    module.def("type_of", [](const std::string &name) { return ClassOf(name); });
    module.def("type_of_class", [](py::handle value) { return ClassOf(value); });
    module.def("type_names", [] { return MessageTypeRegistry::Names(); });
    module.def("nearest", &NearestWordHint);
    // As init(self, args, kwargs): the members of a message may have any names.
    module.def("init", [](py::handle self, const py::tuple &given, const py::dict &named)
               { Init(self, given, named); });
    module.def("set_member", &SetMember);
    module.def("encode",
               [](py::handle value)
               {
                   const auto sample = Encode(*OfValue(value).Root, value);
                   return py::bytes(reinterpret_cast<const char *>(sample.data()), sample.size());
               });
    module.def("decode", [](const MessageClass &type, const py::bytes &bytes)
               { return ValueOfBytes(type, BytesOf(bytes)); });
    module.def("to_json",
               [](py::handle value)
               {
                   const MessageClass &type = OfValue(value);
                   return type.Dynamic->ToJson(Encode(*type.Root, value)).value_or("");
               });
    module.def("from_json",
               [](const MessageClass &type, const std::string &json)
               {
                   const EncodedSample encoded = type.Dynamic->FromJson(json);
                   if (!encoded.Sample)
                   {
                       throw py::value_error(type.Name() + ": " + encoded.Reason);
                   }
                   return Decode(*type.Root, *encoded.Sample);
               });
    module.def(
        "label_of",
        [](py::handle cls, const std::string &name)
        {
            const Codec *codec = CodecOf(reinterpret_cast<PyTypeObject *>(cls.ptr()));
            for (const Codec::Field &field : codec != nullptr ? codec->Fields : std::vector<Codec::Field>())
            {
                if (field.Part.Name == name)
                {
                    return field.Part.Label;
                }
            }
            throw py::key_error(name);
        });
    module.def(
        "members",
        [](py::handle cls)
        {
            py::list members;
            const Codec *codec = CodecOf(reinterpret_cast<PyTypeObject *>(cls.ptr()));
            for (const Codec::Field &field : codec != nullptr ? codec->Fields : std::vector<Codec::Field>())
            {
                members.append(py::make_tuple(field.Name, Described(*field.Type)));
            }
            return members;
        });
}

}  // namespace Rabit::Python
