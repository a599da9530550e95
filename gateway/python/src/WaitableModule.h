// The functions of classes that a thread, or an event loop, waits for.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

namespace Rabit::Python
{

template <class Awaited, class Class>
void DefineWaits(Class &awaited)
{
    awaited
        .def("wait", [](Awaited &self, std::optional<double> seconds)
             { return self.Ready().Wait(seconds, [&self] { return self.IsReady(); }); })
        .def("arm", [](Awaited &self) { self.Ready().Arm(); })
        .def("drain", [](Awaited &self) { self.Ready().Drain(); })
        .def_property_readonly("fd", [](Awaited &self) { return self.Ready().Fd(); })
        .def_property_readonly("is_ready", &Awaited::IsReady);
}

}  // namespace Rabit::Python
