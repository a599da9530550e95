#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <array>
#include <utility>

namespace Rabit::Mcap
{
namespace
{

constexpr std::array<std::pair<const char *, ChannelKind>, 9> Words{
    {{"posted", ChannelKind::Posted},
     {"mirrored", ChannelKind::Mirrored},
     {"knew", ChannelKind::Mirrored},
     {"backfilled", ChannelKind::Backfilled},
     {"queue sent", ChannelKind::QueueSent},
     {"queue received", ChannelKind::QueueReceived},
     {"queue refused", ChannelKind::QueueRefused},
     {"recorder", ChannelKind::Recorder},
     {"backfill", ChannelKind::Recorder}}};

ChannelKind KindOf(const std::string &word)
{
    const auto found =
        std::find_if(Words.begin(), Words.end(), [&word](const auto &known) { return known.first == word; });
    return found == Words.end() ? ChannelKind::Other : found->second;
}

// Without `<node>/` at its beginning.
std::string WithoutNode(const std::string &topic, const std::string &node)
{
    const std::string begin = node + "/";
    return topic.starts_with(begin) ? topic.substr(begin.size()) : topic;
}

// Merged recordings of earlier versions name the message of a backfilled channel in its topic alone:
// <recorder>/Recorder/backfilled/<node>/<message>.
std::string MessageOf(const Channel &channel, const std::string &node, const std::string &recorder)
{
    const std::string named = ValueOf(channel.Metadata, "rabit.message");
    return !named.empty() ? named
                          : WithoutNode(WithoutNode(channel.Topic, recorder + "/Recorder/backfilled"), node);
}

}  // namespace

RecordedChannel Describe(const Channel &channel)
{
    RecordedChannel described;
    described.Kind = KindOf(ValueOf(channel.Metadata, "rabit.kind"));
    described.Node = ValueOf(channel.Metadata, "rabit.node");
    described.Recorder = ValueOf(channel.Metadata, "rabit.recorded_by");
    const std::size_t slash = channel.Topic.find('/');
    if ((described.Kind == ChannelKind::Other || described.Node.empty()) && slash != std::string::npos)
    {
        described.Node = channel.Topic.substr(0, slash);
    }
    switch (described.Kind)
    {
        case ChannelKind::Posted:
            described.Recorder = described.Node;
            [[fallthrough]];
        case ChannelKind::Mirrored:
        case ChannelKind::Backfilled:
            described.Message = MessageOf(channel, described.Node, described.Recorder);
            break;
        case ChannelKind::Other:
            described.Message = slash == std::string::npos ? "" : channel.Topic.substr(slash + 1);
            break;
        case ChannelKind::QueueSent:
        case ChannelKind::QueueReceived:
        case ChannelKind::QueueRefused:
        case ChannelKind::Recorder:
            described.Recorder = described.Node;
            break;
    }
    return described;
}

}  // namespace Rabit::Mcap
