#pragma once

#include <string>
#include <string_view>

namespace Rabit
{

// Returns ROS 2's name of a topic on the wire: `rt/chatter` for `/chatter`, `chatter` and `rt/chatter`.
// Names that begin with `rq/` or `rr/` are returned unchanged.
std::string RosTopicName(std::string_view topic);
// Returns ROS 2's name of a type on the wire: `std_msgs::msg::dds_::String_` for `std_msgs::msg::String`.
// Names of that form are returned unchanged.
std::string RosTypeName(std::string_view type);
// Returns why ROS 2 forbids a topic name of any of the forms above, in words behind the name; empty: it may
// be.
std::string WhyNoRosTopic(std::string_view topic);

}  // namespace Rabit
