#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway.idl.h"

// The report of a node on its topics of foreign programs (NodeReports::Kind::Foreign): a line for each, with
// tabs between the members. It has what people look at: no writers, and of the counters the samples alone.
namespace Rabit::ForeignReport
{

// The topics that fit into a report, in their order.
std::string TextOf(const std::vector<Gateway::ForeignTopic> &topics);
// The topics of a report, any bytes. Lines that make no sense are left out. Texts are printable ASCII.
std::vector<Gateway::ForeignTopic> TopicsIn(std::string_view report);

}  // namespace Rabit::ForeignReport
