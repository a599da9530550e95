// Writes the generated source, `<name>.idl.cpp`: the functions and the codecs of the messages.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

std::string EmitSource(const Model &model);

}  // namespace RabitIdl
