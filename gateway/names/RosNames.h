#pragma once

#include <string>
#include <string_view>

namespace Rabit
{

// What ROS 2 calls a topic on the wire: `/chatter`, `chatter` and `rt/chatter` are `rt/chatter`; what begins
// with `rq/` or `rr/` stays as it is.
std::string RosTopicName(std::string_view topic);
// What ROS 2 calls a type on the wire: `std_msgs::msg::String` is `std_msgs::msg::dds_::String_`. One that
// has that form already stays as it is.
std::string RosTypeName(std::string_view type);

}  // namespace Rabit
