#pragma once

#include <string>

#include "recording/RecordingItem.h"

namespace Rabit
{

// The recorder's own streams: JSON, on the topics `<node>/Recorder/<name>`. The log has the schema that
// Foxglove's panel for logs looks for.
namespace JsonStreams
{
RecordingStream Log(const std::string &node);
RecordingStream Managers(const std::string &node);
RecordingStream Clocks(const std::string &node);
RecordingStream Outcomes(const std::string &node);
RecordingStream Events(const std::string &node);
// The steps of one manager, for `rerun`.
RecordingStream Steps(const std::string &node, const std::string &manager);
}  // namespace JsonStreams

}  // namespace Rabit
