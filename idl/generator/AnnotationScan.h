// Finds annotations that idlc itself drops with no more than a warning, so that they can be refused.
#pragma once

#include "Refusals.h"

#include <string>
#include <vector>

namespace RabitIdl
{

// Reads the text of these IDL files and refuses every `@name` that neither idlc knows nor one of the files
// declares
// (`@annotation name`). The text is looked at before the preprocessor: an annotation in a branch that #if
// leaves out is refused too.
void RefuseUnknownAnnotations(const std::vector<std::string> &paths, Refusals &refusals);

}  // namespace RabitIdl
