#include "PlayedFiles.h"

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

}  // namespace

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
    _plan = Replay::PlanReplay(contents, settings);
    _messages = std::make_unique<Replay::RecordedMessages>(std::move(files), _plan);
}

}  // namespace Rabit::Tool
