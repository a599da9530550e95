#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/MessageCursor.h>
#include <rabit/recording/ManagerRerun.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <utility>

#include "recording/rerun/StepText.h"

namespace Rabit
{
namespace
{

using Rerun::ManagerStep;

// A life that is being read.
struct ReadLife
{
    std::vector<ManagerStep> Steps;
    std::string Problem;
};

// The lives of one manager of one node, in a merged file those of one life of the node.
class ReadLives
{
public:
    void Add(ManagerStep step)
    {
        if (step.Number == 0)
        {
            Begin(std::move(step));
            return;
        }
        if (_lives.empty())
        {
            _lives.push_back(
                {{},
                 "its Startup is not in the recording: it begins with step " + std::to_string(step.Number)});
            _current = 0;
        }
        ReadLife &life = _lives[_current];
        if (!life.Problem.empty() || step.Number < life.Steps.size())
        {
            return;  // of no use, or from a second copy of a file
        }
        if (step.Number > life.Steps.size())
        {
            life.Problem = "steps " + std::to_string(life.Steps.size()) + " to " +
                           std::to_string(step.Number - 1) + " are not in the recording";
            return;
        }
        life.Steps.push_back(std::move(step));
    }
    std::vector<ReadLife> Take() { return std::move(_lives); }

private:
    void Begin(ManagerStep step)
    {
        const auto same =
            std::find_if(_lives.begin(), _lives.end(),
                         [&](const ReadLife &life)
                         { return !life.Steps.empty() && life.Steps.front().LogTime == step.LogTime; });
        _current = static_cast<std::size_t>(same - _lives.begin());
        if (same == _lives.end())
        {
            _lives.emplace_back();
            _lives.back().Steps.push_back(std::move(step));
        }
    }

    std::vector<ReadLife> _lives;
    std::size_t _current = 0;
};

// By node, and in a merged file by its life.
using AllLives = std::map<std::pair<std::string, std::string>, ReadLives>;

void ReadFile(const std::string &path, const std::string &manager, const std::string &node, AllLives &all,
              std::vector<std::string> &problems)
{
    Mcap::FileSource source(path);
    const Mcap::Contents contents = ReadContents(source);
    std::vector<std::string> found = contents.Problems;
    std::map<std::uint16_t, ReadLives *> wanted;
    for (const auto &[number, channel] : contents.Channels)
    {
        const std::string of = Mcap::ValueOf(channel.Metadata, "rabit.node");
        if (Mcap::ValueOf(channel.Metadata, "rabit.manager") == manager && (node.empty() || node == of))
        {
            wanted[number] = &all[{of, Mcap::ValueOf(channel.Metadata, "rabit.life")}];
        }
    }
    Mcap::MessageCursor::Selection selection;
    selection.Wants = [&wanted](std::uint16_t channel) { return wanted.count(channel) != 0; };
    Mcap::MessageCursor cursor(source, contents, selection);
    while (const auto message = cursor.Next())
    {
        const char *const text = reinterpret_cast<const char *>(message->Data.data());
        if (auto step = Rerun::StepOf({text, message->Data.size()}))
        {
            step->LogTime = message->PublishTime;
            wanted.at(message->ChannelId)->Add(std::move(*step));
        }
        else
        {
            found.push_back("a step that cannot be read");
        }
    }
    found.insert(found.end(), cursor.Problems().begin(), cursor.Problems().end());
    for (const std::string &problem : found)
    {
        problems.push_back(path + ": " + problem);
    }
}

}  // namespace

std::vector<ManagerRecording> ManagerRecording::Read(const std::vector<std::string> &files,
                                                     const std::string &manager, const std::string &node,
                                                     std::vector<std::string> &problems)
{
    // File names are numbered in the order of time.
    std::vector<std::string> inOrder = files;
    std::sort(inOrder.begin(), inOrder.end(),
              [](const std::string &left, const std::string &right)
              { return std::filesystem::path(left).filename() < std::filesystem::path(right).filename(); });
    AllLives all;
    for (const std::string &path : inOrder)
    {
        try
        {
            ReadFile(path, manager, node, all, problems);
        }
        catch (const std::exception &error)
        {
            problems.push_back(error.what());
        }
    }
    std::vector<ManagerRecording> recordings;
    for (auto &[key, lives] : all)
    {
        for (ReadLife &life : lives.Take())
        {
            ManagerRecording recording;
            recording._node = key.first;
            recording._manager = manager;
            recording._problem = std::move(life.Problem);
            recording._steps = std::make_shared<const std::vector<ManagerStep>>(std::move(life.Steps));
            recordings.push_back(std::move(recording));
        }
    }
    if (recordings.empty())
    {
        problems.push_back("no steps of a manager " + manager + (node.empty() ? "" : " of " + node) +
                           " were recorded");
    }
    return recordings;
}

std::size_t ManagerRecording::NumberOfSteps() const
{
    return _steps->size();
}

}  // namespace Rabit
