// The class, the functions and the codec of a union.
#pragma once

#include "model/Model.h"
#include "model/TextBuilder.h"

namespace RabitIdl
{

// The class, for the header.
void EmitUnionClass(TextBuilder &out, const UnionDefinition &definition);
// Its functions, for the source.
void EmitUnionFunctions(TextBuilder &out, const UnionDefinition &definition);
// The codec's functions, for the source.
void EmitUnionCodec(TextBuilder &out, const UnionDefinition &definition);

}  // namespace RabitIdl
