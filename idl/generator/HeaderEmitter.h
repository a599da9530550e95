// Writes the generated header, `<name>.idl.h`, which users of the messages include.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

std::string EmitHeader(const Model &model);

}  // namespace RabitIdl
