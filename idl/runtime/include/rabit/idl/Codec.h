#pragma once

// The parts of the runtime that generated headers need: only declarations, so that including a message
// costs little.

#include <cstddef>

namespace Rabit
{
class MessageType;
}

namespace Rabit::Idl
{
class CdrReader;
class CdrSizer;
class CdrWriter;
class KeyHasher;
class TextWriter;

// Converts values of one generated type to XCDR1 and back. Specialised by generated code for every struct,
// union, enum and bitmask, with these members:
//   MinSize           bytes that every value takes at least
//   Write, Read       false if the value cannot be expressed, or the bytes are not such a value
//   Scan              passes by a value without storing it, by the rules of Read; adds its key to the hasher,
//   if
//                     that is not null
//   Size              adds what Write would write
//   Print             appends the value for people
// and for structs and unions also
//   FreshSize         bytes that a new value allocates at most: texts of @default
// and for structs also
//   FixedSize         bytes of every value at offset 0, 0 if values differ in size
//   HasKey            whether there are @key members
//   KeyFitsHash       whether no key takes more than 16 bytes, so that the key hash is the key itself
template <class T>
struct Codec;

}  // namespace Rabit::Idl
