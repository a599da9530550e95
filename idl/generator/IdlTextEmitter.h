// Writes one struct back as IDL, together with all that it uses, in one fixed form: what MessageType::IdlText
// gives.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

// IDL that compiles by itself, in as few words as it can: members of bases are the struct's own, constants
// are their values, names have `::` before them and enumerators and bits a number only where it is needed.
// Depends on the definitions alone, not on comments, layout, constants or files.
std::string EmitIdlText(const Model &model, const StructDefinition &definition);

}  // namespace RabitIdl
