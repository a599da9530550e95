// Finds in the text of IDL files what idlc drops or misreads without an error, so that it can be refused.
#pragma once

#include "model/Refusals.h"

#include <string>
#include <vector>

namespace RabitIdl
{

// Refuses, in the text of these IDL files,
//   - every annotation `@name` that neither idlc knows nor one of the files declares (`@annotation name`):
//   idlc
//     passes over it with a warning;
//   - `#pragma DCPS_DATA_KEY`, by which some compilers are told the keys: idlc passes over it;
//   - hexadecimal escapes with letters in strings and characters: idlc 0.10.2 takes '\x1f' for another
//   character.
// The text is looked at before the preprocessor: what a branch of #if leaves out is refused too.
void RefuseWhatIdlcMisreads(const std::vector<std::string> &paths, Refusals &refusals);

}  // namespace RabitIdl
