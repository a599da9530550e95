#include "recording/merge/MergedChannels.h"

#include <rabit/gateway/SchemaText.h>
#include <rabit/mcap/RecordedChannel.h>

#include <utility>

namespace Rabit::Merge
{

MergedChannels::MergedChannels(const Lives &lives, const MergePlan &plan, Mcap::McapWriter &writer)
    : _lives(lives), _plan(plan), _writer(writer)
{
}

std::string MergedChannels::TopicOf(std::size_t life, const Mcap::Channel &channel) const
{
    const std::string recorder = _lives.All[life].Node + "/Recorder/";
    const Mcap::ChannelKind kind = Mcap::Describe(channel).Kind;
    return kind == Mcap::ChannelKind::Mirrored ? recorder + "knew/" + channel.Topic
           // The recording of its origin may be here, too.
           : kind == Mcap::ChannelKind::Backfilled ? recorder + "backfilled/" + channel.Topic
                                                   : channel.Topic;
}

std::optional<MergedChannels::Made> MergedChannels::Of(std::size_t life, const Mcap::Contents &contents,
                                                       std::uint16_t channel)
{
    const auto found = contents.Channels.find(channel);
    if (found == contents.Channels.end())
    {
        return std::nullopt;
    }
    const Mcap::Channel &original = found->second;
    const auto schema = contents.Schemas.find(original.SchemaId);
    const std::uint16_t number =
        schema == contents.Schemas.end()
            ? std::uint16_t{0}
            : SchemaOf(schema->second.Name, schema->second.Encoding, schema->second.Data);
    Mcap::TextMap metadata = original.Metadata;
    const Mcap::RecordedChannel described = Mcap::Describe(original);
    if (described.Kind == Mcap::ChannelKind::Mirrored)
    {
        metadata["rabit.kind"] = "knew";
    }
    if (described.Kind == Mcap::ChannelKind::Mirrored || described.Kind == Mcap::ChannelKind::Backfilled)
    {
        metadata["rabit.message"] = described.Message;
    }
    const auto made = Make(life, number, TopicOf(life, original), original.MessageEncoding, metadata);
    if (!made)
    {
        return std::nullopt;
    }
    const std::string recorder = _lives.All[life].Node + "/Recorder/";
    const bool isJson = original.MessageEncoding == "json";
    return Made{*made, isJson && original.Topic == recorder + "Clocks" ? Inside::Clocks
                       : isJson && original.Topic == recorder + "Log"  ? Inside::LogLine
                                                                       : Inside::Nothing};
}

std::optional<std::uint16_t> MergedChannels::TimeLineOf(std::size_t life)
{
    const std::string schema = R"({"type":"object","properties":{
"life":{"type":"integer"},
"incarnation":{"type":"string"},
"clock":{"type":"string","description":"time line, relations or wall clock"},
"by":{"type":"array","items":{"type":"string"},"description":"nodes between it and the time line, at some time"},
"later_by_ns":{"type":"string","description":"what was added to the times of the recording"},
"uncertain_by_ns":{"type":"integer","description":"how wrong that may be; null: not known"}}})";
    return Make(life, SchemaOf("rabit.TimeLine", "jsonschema", schema),
                _lives.All[life].Node + "/Recorder/TimeLine", "json",
                {{"rabit.kind", "recorder"}, {"rabit.node", _lives.All[life].Node}});
}

std::uint16_t MergedChannels::SchemaOf(const std::string &name, const std::string &encoding,
                                       const std::string &text)
{
    // One definition has one text, whichever version of Rabit recorded it.
    const std::string written = encoding == "omgidl" ? SchemaText(text) : text;
    const auto [known, isNew] = _schemas.try_emplace({name, encoding, written});
    if (isNew)
    {
        known->second = _writer.AddSchema(name, encoding, written);
    }
    return known->second;
}

std::optional<std::uint16_t> MergedChannels::Make(std::size_t life, std::uint16_t schema,
                                                  const std::string &topic, const std::string &encoding,
                                                  Mcap::TextMap metadata)
{
    const auto [known, isNew] = _channels.try_emplace({life, schema, topic, encoding});
    if (isNew)
    {
        const Life &recorded = _lives.All[life];
        metadata["rabit.recorded_by"] = recorded.Node;
        metadata["rabit.life"] = std::to_string(_plan.Lives[life].Number);
        if (recorded.Clock)
        {
            metadata["rabit.incarnation"] = std::to_string(recorded.Incarnation);
        }
        known->second = _writer.AddChannel(schema, topic, encoding, metadata);
    }
    return known->second;
}

}  // namespace Rabit::Merge
