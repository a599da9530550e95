// Refuses constructs in IDL files that idlc drops or misreads without an error.
#pragma once

#include "model/Refusals.h"

#include <string>
#include <vector>

namespace RabitIdl
{

// Refuses, in the text of these IDL files,
//   - every annotation `@name` that neither idlc knows nor one of the files declares (`@annotation name`):
//     idlc ignores it with a warning;
//   - `#pragma DCPS_DATA_KEY`, which declares keys for some compilers: idlc ignores it;
//   - hexadecimal escapes with letters in strings and characters: idlc 0.10.2 takes '\x1f' for another
//     character.
// The text is scanned before preprocessing, so excluded branches of #if are scanned too.
void RefuseWhatIdlcMisreads(const std::vector<std::string> &paths, Refusals &refusals);

}  // namespace RabitIdl
