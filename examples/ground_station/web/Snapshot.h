#pragma once

#include "EventLog.h"
#include "StationData.h"

#include <cstddef>
#include <deque>
#include <string>

namespace Ground
{

// Numbers of the newest commands and events in a snapshot.
inline constexpr std::size_t CommandsInSnapshot = 40;
inline constexpr std::size_t EventsInSnapshot = 40;
// Number of current problems in a snapshot; all are counted.
inline constexpr std::size_t ProblemsInSnapshot = 20;
// Number of held-back streams, and of links, in a snapshot; all are counted.
inline constexpr std::size_t HeldInSnapshot = 20;

// The snapshot for the page, as JSON. Units and names are those of the IDL; unknown values are null or left
// out. Every part has its age at `server_s`, from which the page counts on. Texts from the network are made
// valid UTF-8, but otherwise unchanged: the page must show them as text only.
std::string SnapshotText(const StationData &data, const std::deque<StationEvent> &events);

}  // namespace Ground
