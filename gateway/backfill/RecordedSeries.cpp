#include "backfill/RecordedSeries.h"

#include <rabit/mcap/RecordedChannel.h>

namespace Rabit::Backfill
{

std::optional<RecordedSeries> SeriesIn(const Mcap::Channel &channel)
{
    const Mcap::RecordedChannel described = Mcap::Describe(channel);
    RecordedSeries series;
    if ((described.Kind != Mcap::ChannelKind::Mirrored && described.Kind != Mcap::ChannelKind::Backfilled) ||
        !ReadNumber(Mcap::ValueOf(channel.Metadata, "rabit.origin_incarnation"), series.Of.Incarnation) ||
        !ReadNumber(Mcap::ValueOf(channel.Metadata, "rabit.source_to_log_ns"), series.SourceToLog))
    {
        return std::nullopt;
    }
    series.Of.Node = described.Node;
    series.Of.Message = described.Message;
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
