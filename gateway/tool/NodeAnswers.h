#pragma once

#include <rabit/base/NaturalOrder.h>
#include <rabit/gateway/FleetExplorer.h>

#include <map>
#include <optional>
#include <string>

#include "FleetSession.h"

namespace Rabit::Tool
{

// The answers of nodes to one question, by node; empty: it has not answered.
using NodeAnswers = std::map<std::string, std::optional<std::string>, NaturalOrder>;

// Requests a report of each live node, and waits until all have answered, at most until `until`, in seconds
// from the start of the session.
NodeAnswers AnswersOfAll(FleetSession &session, FleetExplorer::Report what, double until);

}  // namespace Rabit::Tool
