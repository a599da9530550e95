// C++ spellings of the types and values of a model.
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

// The C++ type of a primitive, for instance `::std::uint16_t`.
std::string CppPrimitive(Primitive primitive);
// The C++ type, fully qualified: `::std::vector<::Uav::Pose>`.
std::string CppType(const Type &type);
// The maker of new values of the type: `::Rabit::Idl::FreshEnum<::Uav::Mode, ::Uav::Mode::IDLE>`. Needed
// for enums that do not start at 0, as C++ would make them 0; empty if C++ makes the right values.
std::string MakerOf(const Type &type);
// The codec for values of the type: `::Rabit::Idl::List<::Rabit::Idl::Codec<::Uav::Pose>, 0>`.
std::string CodecOf(const Type &type);
// A value of the type.
std::string CppLiteral(const Literal &value, const Type &type);
// A value of a union's discriminator.
std::string CppLabel(std::int64_t value, const Type &discriminator);
// The text behind a member's name in its declaration: ` = 5`, `{}` or nothing.
std::string Initializer(const Member &member);
// True if a function should take the type by value.
bool IsSmall(const Type &type);

}  // namespace RabitIdl
