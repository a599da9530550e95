// New values, equal to those of generated code.
#pragma once

#include <rabit/dynamic/CdrBuilder.h>
#include <rabit/dynamic/Shape.h>

namespace Rabit::Dynamic
{

// At most Shape::FreshSize bytes.
void PutFresh(CdrBuilder &out, const Shape &shape);
// For a member: its @default, else a new value of its type.
void PutFresh(CdrBuilder &out, const Part &part);

}  // namespace Rabit::Dynamic
