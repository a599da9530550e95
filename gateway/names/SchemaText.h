#pragma once

#include <string>

namespace Rabit
{

// The IDL text of a type for readers of other makers. MessageType::IdlText escapes each name that IDL takes
// for a keyword in any case (`_String`). Other readers know keywords in one case alone, and take the
// underscore for a part of the name: it is left out before such names. DynamicType::Parse reads both.
std::string SchemaText(const std::string &idlText);

}  // namespace Rabit
