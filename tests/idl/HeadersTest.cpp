// Generated headers need no more than C++17, and compile without warnings in the user's code. Only compiled.
#include "basics.idl.h"
#include "constructs.idl.h"
#include "keys.idl.h"
#include "limits.idl.h"
#include "names.idl.h"
#include "uav.idl.h"

static_assert(__cplusplus < 202002L, "this file is meant to be compiled as C++17");
static_assert(!(Constructs::Flags8::LOW == Constructs::Flags8::HIGH));
static_assert((Constructs::Flags64::A64 | Constructs::Flags64::Z64) != Constructs::Flags64::A64);
