#include "backfill/RecordedSeries.h"

namespace Rabit::Backfill
{

std::string TextAt(const Mcap::TextMap &values, const std::string &key)
{
    const auto found = values.find(key);
    return found == values.end() ? "" : found->second;
}

std::optional<RecordedSeries> SeriesIn(const Mcap::Channel &channel)
{
    const std::string kind = TextAt(channel.Metadata, "rabit.kind");
    RecordedSeries series;
    series.Of.Node = TextAt(channel.Metadata, "rabit.node");
    if ((kind != "mirrored" && kind != "backfilled") ||
        !ReadNumber(TextAt(channel.Metadata, "rabit.origin_incarnation"), series.Of.Incarnation) ||
        !ReadNumber(TextAt(channel.Metadata, "rabit.source_to_log_ns"), series.SourceToLog) ||
        !channel.Topic.starts_with(series.Of.Node + "/"))
    {
        return std::nullopt;
    }
    series.Of.Message = channel.Topic.substr(series.Of.Node.size() + 1);
    return series;
}

// The message has the lower half of it: the stamp is the one that is nearest to the time of the post. The
// clocks of two nodes drift apart by far less than the 36 minutes by which this would be wrong.
Stamp StampIn(const Mcap::Message &message, std::int64_t sourceToLog)
{
    constexpr Stamp turn = Stamp{1} << 32;
    const Stamp about = StampOf(static_cast<std::int64_t>(message.PublishTime) - sourceToLog);
    const Stamp stamp = (about & ~(turn - 1)) | message.Sequence;
    if (stamp > about + turn / 2 && stamp >= turn)
    {
        return stamp - turn;
    }
    return stamp + turn / 2 < about ? stamp + turn : stamp;
}

}  // namespace Rabit::Backfill
