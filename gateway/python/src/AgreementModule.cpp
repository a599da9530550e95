#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "Agreement.h"
#include "Module.h"
#include "WaitableModule.h"

namespace Rabit::Python
{

namespace py = pybind11;

namespace
{

// A text that is not UTF-8 keeps its bytes, as file names do in Python.
std::string TextIn(const py::str &value)
{
    const auto bytes =
        py::reinterpret_steal<py::object>(PyUnicode_AsEncodedString(value.ptr(), "utf-8", "surrogateescape"));
    if (!bytes)
    {
        throw py::error_already_set();
    }
    return {PyBytes_AS_STRING(bytes.ptr()), static_cast<std::size_t>(PyBytes_GET_SIZE(bytes.ptr()))};
}

// The same, and refuses a text of another length. `what`: for the error.
std::string TextIn(const py::str &value, const std::string &what, std::size_t least, std::size_t most)
{
    std::string text = TextIn(value);
    if (text.size() < least || text.size() > most)
    {
        throw py::value_error(what + ": expected " + std::to_string(least) + " to " + std::to_string(most) +
                              " bytes, not " + std::to_string(text.size()));
    }
    return text;
}

std::string KeyIn(const py::str &value)
{
    return TextIn(value, "key", 1, SharedTable::LongestKey);
}

py::object StrOf(std::string_view text)
{
    auto value = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
    if (!value)
    {
        throw py::error_already_set();
    }
    return value;
}

py::list ListOf(const std::vector<std::string> &texts)
{
    py::list list;
    for (const std::string &text : texts)
    {
        list.append(StrOf(text));
    }
    return list;
}

// The value of a key, whatever its kind. A key that two nodes use in two ways may change its kind meanwhile,
// but only to a later one of these.
py::object ValueIn(const SharedTable &table, const std::string &key)
{
    if (const auto text = table.Text(key))
    {
        return StrOf(*text);
    }
    if (const auto numbers = table.Numbers(key); !numbers.empty())
    {
        return py::cast(numbers);
    }
    return py::cast(table.Number(key));
}

void DefineClaims(py::class_<Agreement, std::shared_ptr<Agreement>> &agreement)
{
    agreement
        .def("acquire",
             [](Agreement &self, const py::str &claim, bool once)
             {
                 const std::string name = TextIn(claim, "claim", 1, Claims::LongestName);
                 const py::gil_scoped_release released;
                 return self.Acquire(name, once);
             })
        .def("release",
             [](Agreement &self, const py::str &claim)
             {
                 const std::string name = TextIn(claim);
                 const py::gil_scoped_release released;
                 self.Release(name);
             })
        .def("status",
             [](const Agreement &self, const py::str &claim)
             {
                 const Claims::Status status = self.StatusOf(TextIn(claim));
                 // Other members name the holder, in any bytes.
                 return py::make_tuple(status.IsWanted, status.Fence, StrOf(status.Holder),
                                       StrOf(status.Reason));
             })
        .def("mine", [](const Agreement &self) { return ListOf(self.Mine()); })
        .def("until_decided", [](Agreement &self, const py::str &claim)
             { return self.Wait(TextIn(claim), ClaimWait::Until::Decided); })
        .def("until_lost", [](Agreement &self, const py::str &claim)
             { return self.Wait(TextIn(claim), ClaimWait::Until::Lost); });
}

void DefineTable(py::class_<Agreement, std::shared_ptr<Agreement>> &agreement)
{
    agreement
        .def("write",
             [](Agreement &self, const py::str &key, const py::str &value)
             {
                 const std::string name = KeyIn(key);
                 const std::string text = TextIn(value, "value", 0, SharedTable::LongestValue);
                 const py::gil_scoped_release released;
                 return std::string(self.Table().Write(name, text));
             })
        .def("add",
             [](Agreement &self, const py::str &key, std::int64_t number)
             {
                 const std::string name = KeyIn(key);
                 if (number < 0 || number > static_cast<std::int64_t>(SharedTable::HighestNumber))
                 {
                     throw py::value_error("expected a number from 0 to " +
                                           std::to_string(SharedTable::HighestNumber) + ", not " +
                                           std::to_string(number));
                 }
                 const py::gil_scoped_release released;
                 return std::string(self.Table().Add(name, static_cast<std::size_t>(number)));
             })
        .def("raise_",
             [](Agreement &self, const py::str &key, std::int64_t number)
             {
                 const std::string name = KeyIn(key);
                 const py::gil_scoped_release released;
                 return std::string(self.Table().Raise(name, number));
             })
        .def("read", [](Agreement &self, const py::str &key) { return ValueIn(self.Table(), TextIn(key)); })
        .def("keys", [](Agreement &self) { return ListOf(self.Table().Keys()); });
}

}  // namespace

void DefineAgreement(py::module_ &module)
{
    py::class_<ClaimWait, std::shared_ptr<ClaimWait>> wait(module, "ClaimWait");
    DefineWaits<ClaimWait>(wait);
    py::class_<Agreement, std::shared_ptr<Agreement>> agreement(module, "AgreementCore");
    DefineClaims(agreement);
    DefineTable(agreement);
}

}  // namespace Rabit::Python
