// Writes the generated header, `<name>.idl.h`: what users of the messages see.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

std::string EmitHeader(const Model &model);

}  // namespace RabitIdl
