// A message of ROS 2 as an IDL file.
#pragma once

#include "ros/MsgFile.h"

#include <string>

namespace RabitIdl
{

// The struct `package::msg::Name`, the module `Name_Constants` beside it if it has constants, and includes of
// `package/msg/Other.idl` for the messages that it holds, as rosidl makes it. Arrays need no typedefs here.
std::string MsgToIdl(const MsgFile &file);

}  // namespace RabitIdl
