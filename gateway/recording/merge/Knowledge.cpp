#include "recording/merge/Knowledge.h"

#include <rabit/base/NumberIn.h>
#include <rabit/mcap/MessageCursor.h>
#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "recording/merge/ChannelChunks.h"
#include "recording/merge/ClockPair.h"
#include "recording/merge/ClockReport.h"
#include "recording/merge/Lives.h"

namespace Rabit::Merge
{
namespace
{

// Clock reports are read this far around a moment, since ClockPair looks no further.
constexpr Moment ClocksAround = 100 * OneSecond;

template <typename Number>
std::optional<Number> NumberOf(const Mcap::TextMap &values, const std::string &key)
{
    return NumberIn<Number>(Mcap::ValueOf(values, key));
}

std::vector<KnowerLife> LivesOf(const Mcap::Contents &contents)
{
    std::vector<KnowerLife> lives;
    for (const Mcap::Metadata &metadata : contents.MetadataRecords)
    {
        const Mcap::TextMap &values = metadata.Values;
        if (metadata.Name == "rabit.recording")
        {
            lives.push_back({Mcap::ValueOf(values, "node"), NumberOf<unsigned>(values, "life").value_or(1),
                             NumberOf<std::uint64_t>(values, "incarnation").value_or(0),
                             Within(NumberOf<Moment>(values, "begin_ns").value_or(0)),
                             Within(NumberOf<Moment>(values, "end_ns").value_or(0))});
        }
    }
    if (lives.empty())
    {
        lives.push_back({Mcap::ValueOf(MetadataOf(contents, "rabit.node"), "node"), 1, 0,
                         FromFile(contents.Statistics.StartTime), FromFile(contents.Statistics.EndTime)});
    }
    return lives;
}

// True if a channel is of that life. A recording that was not merged has only one life.
bool IsOf(const Mcap::Channel &channel, const KnowerLife &life)
{
    return channel.Metadata.count("rabit.recorded_by") == 0 ||
           (channel.Metadata.at("rabit.recorded_by") == life.Node &&
            NumberOf<unsigned>(channel.Metadata, "rabit.life") == life.Number);
}

// The last message of some channels from `from` to `to`.
struct Last
{
    Moment LogTime = 0;
    Moment PublishTime = 0;
    Mcap::Bytes Data;
};

std::optional<Last> LastOf(Mcap::ByteSource &source, const ChannelChunks &chunks, Moment from, Moment to,
                           std::vector<std::string> &problems)
{
    Mcap::MessageCursor::Selection selection = chunks.Selection();
    selection.From = ToFile(from);
    selection.To = ToFile(to);
    Mcap::MessageCursor cursor(source, chunks.Contents(), selection);
    std::optional<Last> last;
    while (const auto message = cursor.Next())
    {
        last = {FromFile(message->LogTime),
                FromFile(message->PublishTime),
                {message->Data.begin(), message->Data.end()}};
    }
    problems.insert(problems.end(), cursor.Problems().begin(), cursor.Problems().end());
    return last;
}

// Fills in the poster's incarnation, and how uncertain its clock was to the knower when the value was
// received.
void AddUncertainty(Mcap::ByteSource &source, const Mcap::Contents &contents, const KnowerLife &knower,
                    const std::string &node, KnownValue &value)
{
    const std::string topic = knower.Node + "/Recorder/Clocks";
    const ChannelChunks chunks(contents, [&](const Mcap::Channel &channel)
                               { return channel.Topic == topic && IsOf(channel, knower); });
    Mcap::MessageCursor::Selection selection = chunks.Selection();
    selection.From = ToFile(value.ReceivedAt - ClocksAround);
    selection.To = ToFile(value.ReceivedAt + ClocksAround);
    Mcap::MessageCursor cursor(source, chunks.Contents(), selection);
    std::map<std::uint64_t, ClockPair> pairs;
    while (const auto message = cursor.Next())
    {
        const auto report = ReadClockReport(message->Data);
        const Moment at = FromFile(message->LogTime);
        for (const ClockReport::Peer &peer : report ? report->Peers : std::vector<ClockReport::Peer>())
        {
            if (peer.Node != node)
            {
                continue;
            }
            pairs[peer.Incarnation].Add(at, Within(at - peer.SourceToLog), peer.UncertainBy);
            // The incarnation that was known at that time, or else the first that became known.
            const bool isKnown = value.Incarnation != 0 && at > value.ReceivedAt;
            value.Incarnation = isKnown ? value.Incarnation : peer.Incarnation;
        }
    }
    const auto pair = pairs.find(value.Incarnation);
    if (pair == pairs.end())
    {
        return;
    }
    pair->second.Finish();
    if (const auto reading = pair->second.ToSecond(value.ReceivedAt))
    {
        value.UncertainBy = reading->Bound;
    }
}

}  // namespace

Knowledge::Knowledge(const Mcap::Contents &contents)
    : Lives(LivesOf(contents)),
      WorstBound(NumberOf<Moment>(MetadataOf(contents, "rabit.merge"), "uncertain_by_ns"))
{
    std::map<std::tuple<std::size_t, std::string, std::string, std::string>, std::size_t> known;
    for (const auto &[id, channel] : contents.Channels)
    {
        const Mcap::RecordedChannel described = Mcap::Describe(channel);
        const std::string &node = described.Node;
        const std::string &message = described.Message;
        const auto schema = contents.Schemas.find(channel.SchemaId);
        const auto life =
            std::find_if(Lives.begin(), Lives.end(),
                         [&given = channel](const KnowerLife &one) { return IsOf(given, one); });
        // A backfilled post was not known then.
        if ((described.Kind != Mcap::ChannelKind::Mirrored && described.Kind != Mcap::ChannelKind::Posted) ||
            node.empty() || life == Lives.end())
        {
            continue;
        }
        const auto at = static_cast<std::size_t>(life - Lives.begin());
        const std::string type = schema == contents.Schemas.end() ? "" : schema->second.Name;
        const auto [stream, isNew] = known.try_emplace({at, node, message, type}, Streams.size());
        if (isNew)
        {
            Streams.push_back(
                {at, node, message, type, schema == contents.Schemas.end() ? "" : schema->second.Data, {}});
        }
        Streams[stream->second].Channels.insert(id);
    }
    const auto order = [this](const KnownStream &stream)
    {
        const KnowerLife &life = Lives[stream.Life];
        return std::tie(life.Node, life.Number, stream.Node, stream.Message);
    };
    std::stable_sort(Streams.begin(), Streams.end(),
                     [&order](const KnownStream &one, const KnownStream &other)
                     { return order(one) < order(other); });
}

std::optional<KnownValue> ValueAt(Mcap::ByteSource &source, const Mcap::Contents &contents,
                                  const Knowledge &knowledge, const KnownStream &stream, Moment at,
                                  std::vector<std::string> &problems)
{
    const KnowerLife &knower = knowledge.Lives[stream.Life];
    const ChannelChunks chunks(contents, stream.Channels);
    std::optional<Last> last;
    // Looks further and further back, since most values are recent.
    for (Moment back = 10 * OneSecond; !last; back *= 8)
    {
        const Moment from = std::max(knower.Begin, at - back);
        std::vector<std::string> found;
        last = LastOf(source, chunks, from, at, found);
        if (from == knower.Begin || last)
        {
            problems.insert(problems.end(), found.begin(), found.end());
            break;
        }
    }
    if (!last)
    {
        return std::nullopt;
    }
    KnownValue value{last->LogTime, last->PublishTime, std::move(last->Data), std::nullopt, 0};
    if (stream.Node == knower.Node)
    {
        value.UncertainBy = 0;
        value.Incarnation = knower.Incarnation;
    }
    else
    {
        AddUncertainty(source, contents, knower, stream.Node, value);
    }
    return value;
}

}  // namespace Rabit::Merge
