// Refuses, before the C parser sees it, what a text from a stranger must not contain.
#pragma once

#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// Why a text is not given to the parser, or an empty text.
//
// The parser is made for its user's own files: idlc 0.10.2 crashes while it tidies up after some texts that
// are not grammatical, and spends a time that doubles with each line of others. So what reaches it is
// grammatical, and of the part of IDL that MessageType::IdlText gives: no directives, constants, expressions,
// forward declarations nor annotations but those of types, and within Limits.h. Names and what they mean are
// the parser's matter, except that all must be declared before they are used, once. Time and memory are
// linear in the text, but for a logarithm.
std::string WhyNotParsed(std::string_view idlText);

}  // namespace Rabit::Dynamic
