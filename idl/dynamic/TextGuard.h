// Refuses, before the C parser sees it, what a text from a stranger must not contain.
#pragma once

#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// Looks at the tokens of an IDL text, not at its grammar: at characters, numbers, names, brackets, which
// annotations and signs there are, and how many of all, against Limits.h. What passes is about what
// MessageType::IdlText gives: no directives, no constants or expressions, no annotations but those of types.
// Returns why it is refused, or an empty text. Time and memory are linear in the text.
std::string WhyNotParsed(std::string_view idlText);

}  // namespace Rabit::Dynamic
