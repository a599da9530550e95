// New values, as those of generated code start.
#pragma once

#include "dynamic/CdrBuilder.h"
#include "dynamic/Shape.h"

namespace Rabit::Dynamic
{

// At most Shape::FreshSize bytes.
void PutFresh(CdrBuilder &out, const Shape &shape);
// A member: its @default, else a new value of its type.
void PutFresh(CdrBuilder &out, const Part &part);

}  // namespace Rabit::Dynamic
