// Refuses unsafe constructs of untrusted texts before the C parser sees them.
#pragma once

#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// Returns why a text must not be given to the parser; empty if it may.
//
// The parser is made for its user's own files: idlc 0.10.2 crashes while it cleans up after some
// ungrammatical texts; on others its time doubles with each line. So only grammatical texts within Limits.h
// pass, in the part of IDL that MessageType::IdlText uses: no directives, constants, expressions, forward
// declarations, and no annotations except those of types. The parser resolves names; this only checks that
// each is declared once, before it is used. Time and memory are linear in the text, except for a logarithm.
std::string WhyNotParsed(std::string_view idlText);

}  // namespace Rabit::Dynamic
