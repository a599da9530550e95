// A message of ROS 2 as an IDL file.
#pragma once

#include "ros/MsgFile.h"

#include <string>

namespace RabitIdl
{

// Returns IDL as rosidl writes it: the struct `package::msg::Name`, the module `Name_Constants` beside it
// if there are constants, and includes of `package/msg/Other.idl` for the messages that it contains. Unlike
// in rosidl, arrays have no typedefs.
std::string MsgToIdl(const MsgFile &file);

}  // namespace RabitIdl
