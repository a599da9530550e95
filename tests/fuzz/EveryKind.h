// A type with a member of every kind, and a key.
#pragma once

#include <rabit/dynamic/DynamicType.h>

#include "Input.h"

namespace Fuzz
{

inline const Rabit::DynamicType &EveryKind()
{
    static const auto type = Rabit::DynamicType::Parse(R"(
module Fuzz {
  enum Colour { RED, GREEN, @value(7) BLUE };
  @bit_bound(16) bitmask Flags { @position(0) FIRST, @position(9) LAST };
  @final struct Inner { octet bytes[3]; sequence<octet, 9> more; string<5> word; };
  @final union Choice switch (long) { case 1: case 2: Inner inner; case -3: double number; default: Colour colour; };
  @final struct Every {
    @key long id;
    boolean yes; char letter; octet byte; int8 tiny; short little; unsigned short us; unsigned long ul;
    long long large; unsigned long long ull; float real; double precise;
    string text; sequence<string, 4> texts; Colour colour; Flags flags;
    Inner nested[2]; sequence<Inner> inners; Choice choice; sequence<Choice, 3> choices; long grid[2][3];
  };
};
)",
                                                       "Fuzz::Every");
    Require(type.Type != nullptr);
    return *type.Type;
}

}  // namespace Fuzz
