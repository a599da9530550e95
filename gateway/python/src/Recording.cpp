#include "Recording.h"

#include <rabit/RabitVersion.h>
#include <rabit/mcap/FileSink.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "Values.h"
#include "recording/merge/Merger.h"

namespace Rabit::Python
{
namespace
{

Mcap::Contents Read(Mcap::FileSource &file, const std::string &path)
{
    if (!Mcap::IsRecording(file))
    {
        throw std::runtime_error(path + ": is no recording (MCAP)");
    }
    return Mcap::ReadContents(file);
}

}  // namespace

Recording::Recording(const std::string &path) : _file(path), _contents(Read(_file, path)) {}

std::shared_ptr<MessageClass> Recording::ClassOfChannel(std::uint16_t channel, std::string &why)
{
    auto [known, isNew] = _classes.try_emplace(channel);
    auto &[type, reason] = known->second;
    const auto found = _contents.Channels.find(channel);
    if (isNew && found != _contents.Channels.end() && found->second.MessageEncoding != "json")
    {
        const auto schema = _contents.Schemas.find(found->second.SchemaId);
        if (found->second.MessageEncoding != "cdr" || schema == _contents.Schemas.end())
        {
            reason =
                found->second.Topic + ": messages in `" + found->second.MessageEncoding + "` are not decoded";
        }
        else if (const ParsedType parsed = DynamicType::Parse(schema->second.Data, schema->second.Name);
                 parsed.Type)
        {
            type = ClassOfRecorded(parsed.Type);
        }
        else
        {
            reason = found->second.Topic + ": " + parsed.Reason;
        }
    }
    why = reason;
    return type;
}

Recording::Messages::Messages(std::shared_ptr<Recording> recording, std::set<std::uint16_t> channels,
                              std::uint64_t from, std::uint64_t to)
    : _recording(std::move(recording)),
      _cursor(_recording->_file, _recording->_contents,
              {from, to, [channels = std::move(channels)](std::uint16_t channel) {
                   return channels.count(channel) != 0;
               }})
{
}

py::object Recording::Messages::ValueOf(const Mcap::Message &message, const Mcap::Channel &channel,
                                        std::string &why)
{
    if (channel.MessageEncoding == "json")
    {
        return py::reinterpret_steal<py::object>(
            PyUnicode_DecodeUTF8(reinterpret_cast<const char *>(message.Data.data()),
                                 static_cast<Py_ssize_t>(message.Data.size()), "replace"));
    }
    const auto type = _recording->ClassOfChannel(message.ChannelId, why);
    if (!type)
    {
        return {};
    }
    const auto sample = type->Dynamic->Normalized(message.Data);
    if (!sample)
    {
        why = channel.Topic + ": the bytes do not fit the type";
        return {};
    }
    return Decode(*type->Root, *sample);
}

py::tuple Recording::Messages::Next()
{
    while (const auto message = _cursor.Next())
    {
        const auto channel = _recording->_contents.Channels.find(message->ChannelId);
        std::string why = "a message of no channel";
        if (channel != _recording->_contents.Channels.end())
        {
            if (const py::object value = ValueOf(*message, channel->second, why))
            {
                return py::make_tuple(channel->second.Topic, message->LogTime, message->PublishTime, value);
            }
        }
        ++_undecoded[why];
    }
    throw py::stop_iteration();
}

std::vector<std::string> MergeRecordings(const std::vector<std::string> &files, const std::string &to,
                                         const std::string &reference, bool takesWallClocks)
{
    const Merge::OpenFile open = [](const std::string &path)
    { return std::make_unique<Mcap::FileSource>(path); };
    const Merge::Lives lives = Merge::ReadLives(open, files);
    if (!lives.Problem.empty())
    {
        throw std::runtime_error(lives.Problem);
    }
    const Merge::MergePlan plan = MakePlan(lives, {reference, takesWallClocks});
    if (!plan.Problem.empty())
    {
        throw std::runtime_error(
            plan.Problem + (takesWallClocks ? ""
                                            : "; wall_clock=True takes it by its wall clock, which may be "
                                              "wrong by anything"));
    }
    Mcap::FileSink file(to);
    Mcap::McapWriter writer(file, {"rabit " RABIT_VERSION_STRING, "rabit", true});
    const Merge::Merged merged = Merge::Merger(open, lives, plan, writer).Run([] { return false; });
    if (!merged.IsWritten || !file.Sync())
    {
        std::error_code ignored;
        std::filesystem::remove(to, ignored);
        throw std::runtime_error(to + ": the disk takes no more; it is removed");
    }
    std::vector<std::string> remarks = lives.Remarks;
    remarks.insert(remarks.end(), merged.Problems.begin(), merged.Problems.end());
    return remarks;
}

}  // namespace Rabit::Python
