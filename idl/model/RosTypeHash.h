// The hash by which ROS 2 names the definition of a message type (REP-2011).
#pragma once

#include "model/Model.h"

#include <string>

namespace RabitIdl
{

// `RIHS01_` and 64 hexadecimal digits: the SHA-256 of the type's description, as rosidl makes it of the same
// message. Empty if it is no type of ROS 2, which has structs in modules `<package>::msg` (srv, action)
// alone. Their members are numbers, strings, such structs, and one-dimensional arrays and sequences of these.
std::string RosTypeHash(const StructDefinition &definition);

}  // namespace RabitIdl
