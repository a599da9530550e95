// The parts of the extension module, one function for each file that defines some of it.
#pragma once

#include <pybind11/pybind11.h>

namespace Rabit::Python
{

void DefineAgreement(pybind11::module_ &module);
void DefineMessages(pybind11::module_ &module);
void DefineNode(pybind11::module_ &module);
void DefineRecordings(pybind11::module_ &module);

}  // namespace Rabit::Python
