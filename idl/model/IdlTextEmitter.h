// Writes one struct with all types that it uses back as IDL, in one fixed form, for MessageType::IdlText.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

// IDL that compiles by itself, as short as possible: members of bases are the struct's own, and constants
// are their values. Names have `::` before them, and enumerators and bits a number, only where needed.
// Depends on the definitions alone, not on comments, layout, constants or files.
std::string EmitIdlText(const Model &model, const StructDefinition &definition);

}  // namespace RabitIdl
