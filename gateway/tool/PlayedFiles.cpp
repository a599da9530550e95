#include "PlayedFiles.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "Output.h"

namespace Rabit::Tool
{
namespace
{

void AddNodes(std::vector<std::string> &patterns)
{
    for (std::string &pattern : patterns)
    {
        pattern.insert(0, pattern.find('/') == std::string::npos ? "*/" : "");
    }
}

// Throws std::runtime_error for a pattern that no queue of the files fits.
void CheckQueues(const std::vector<const Mcap::Contents *> &contents,
                 const std::vector<std::string> &patterns)
{
    std::set<std::string> queues;
    for (const Replay::ReplayStream &stream : Replay::PlanReplay(contents, {.Queues = {"*/*"}}).Streams)
    {
        if (stream.What == Replay::ReplayStream::Kind::Queue)
        {
            queues.insert(stream.Peer + "/" + stream.Name);
        }
    }
    const std::vector<std::string> there(queues.begin(), queues.end());
    for (const std::string &pattern : patterns)
    {
        if (std::none_of(there.begin(), there.end(),
                         [&](const std::string &queue) { return MatchesPattern(pattern, queue); }))
        {
            throw std::runtime_error(
                "--queues " + pattern + ": the recording has no message for such a queue" +
                (there.empty() ? ", nor for any other" : "; there: " + ListedNames(there)));
        }
    }
}

}  // namespace

std::string NoRecording(const std::string &file)
{
    return file + ": is no recording: it does not begin as an MCAP file";
}

PlayedFiles::PlayedFiles(const std::vector<std::string> &names, Replay::PlanSettings settings)
{
    std::vector<const Mcap::Contents *> contents;
    std::vector<Replay::RecordedMessages::File> files;
    for (const std::string &name : names)
    {
        _files.push_back(std::make_unique<Mcap::FileSource>(name));
        _contents.push_back(std::make_unique<Mcap::Contents>(Mcap::ReadContents(*_files.back())));
        for (const std::string &problem : _contents.back()->Problems)
        {
            Output::Talk(name + ": " + problem);
        }
        contents.push_back(_contents.back().get());
        files.push_back({_files.back().get(), contents.back()});
    }
    AddNodes(settings.Include);
    AddNodes(settings.Exclude);
    AddNodes(settings.Queues);
    CheckQueues(contents, settings.Queues);
    _plan = Replay::PlanReplay(contents, settings);
    _messages = std::make_unique<Replay::RecordedMessages>(std::move(files), _plan);
}

}  // namespace Rabit::Tool
