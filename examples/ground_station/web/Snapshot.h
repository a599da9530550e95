#pragma once

#include "EventLog.h"
#include "StationData.h"

#include <cstddef>
#include <deque>
#include <string>

namespace Ground
{

// The newest commands and events that go into a snapshot.
inline constexpr std::size_t CommandsInSnapshot = 40;
inline constexpr std::size_t EventsInSnapshot = 40;
// The first of the problems there are now; all are counted.
inline constexpr std::size_t ProblemsInSnapshot = 20;
// The first of the streams and of the links that are held back; all are counted.
inline constexpr std::size_t HeldInSnapshot = 20;

// What the page is told, as JSON. Units and names are those of the IDL; what is not known is null or left
// out. Every part has the age that it had at `server_s`, so that the page can count on. Texts from the
// network are made valid UTF-8, and are otherwise as they came: the page must show them as text only.
std::string SnapshotText(const StationData &data, const std::deque<StationEvent> &events);

}  // namespace Ground
