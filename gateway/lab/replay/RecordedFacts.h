#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include "Recording.h"

namespace Rabit::WhatIf
{

// Returns facts of a recorded flight in JSON. "t" and all other times are nanoseconds since the beginning of
// the flight.
//   {"fact": "flight", "end": NS}                                      first
//   {"fact": "note", "text": TEXT}
std::vector<nlohmann::ordered_json> FactsOfFlight(const Recording &recording);
//   {"fact": "life", "file": NAME, "node": NODE, "t": NS, "ended": NS or null}
// `life` is its place in Lives(); "file" names it in other facts.
nlohmann::ordered_json FactOfLife(const Recording &recording, std::size_t life);
// Name of a life in facts.
std::string NameOfLife(const Recording &recording, std::size_t life);
//   {"fact": "flown", "at": NODE, "node": NODE, "message": NAME, "arrived": [NS...], "posted": [NS...]}
// The messages that the recorded nodes received.
std::vector<nlohmann::ordered_json> FactsOfArrivals(const Recording &recording);

}  // namespace Rabit::WhatIf
