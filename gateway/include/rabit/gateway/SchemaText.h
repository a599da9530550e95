#pragma once

#include <string>

namespace Rabit
{

// Returns the IDL text of a type for readers of other makers, as recordings and viewers get it.
// MessageType::IdlText escapes each name that IDL takes for a keyword in any case (`_String`). Other readers
// know keywords in one case alone, and take the underscore for a part of the name: it is left out before such
// names. DynamicType::Parse reads both. Comments and quoted texts stay as they are. Takes any text, and any
// thread may call it.
std::string SchemaText(const std::string &idlText);

}  // namespace Rabit
