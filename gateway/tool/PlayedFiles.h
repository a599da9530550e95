#pragma once

#include <rabit/mcap/FileSource.h>

#include <memory>
#include <string>
#include <vector>

#include "recording/replay/RecordedMessages.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::Tool
{

// The error line for a file that does not begin as an MCAP file.
std::string NoRecording(const std::string &file);

// The files of a replay, and the part of them that is played.
class PlayedFiles
{
public:
    // Reports problems of a file; throws std::runtime_error if one cannot be read at all. A pattern without a
    // slash stands for that message of all nodes.
    PlayedFiles(const std::vector<std::string> &names, Replay::PlanSettings settings);

    const Replay::ReplayPlan &Plan() const { return _plan; }
    Replay::RecordedMessages &Messages() { return *_messages; }
    const Replay::RecordedMessages &Messages() const { return *_messages; }

private:
    std::vector<std::unique_ptr<Mcap::FileSource>> _files;
    std::vector<std::unique_ptr<Mcap::Contents>> _contents;
    Replay::ReplayPlan _plan;
    std::unique_ptr<Replay::RecordedMessages> _messages;
};

}  // namespace Rabit::Tool
