#include "backfill/ReadLedger.h"

#include <nlohmann/json.hpp>

#include "backfill/RecordedSeries.h"
#include "backfill/RecordingIndex.h"
#include "backfill/SeriesStreams.h"

namespace Rabit::Backfill
{
namespace
{

void TakeMark(const Mcap::Message &message, Ledger &ledger)
{
    const auto json = nlohmann::json::parse(message.Data.begin(), message.Data.end(), nullptr, false);
    Series series;
    Range range;
    const auto text = [&json](const char *key)
    {
        const auto found = json.is_object() ? json.find(key) : json.end();
        return json.is_object() && found != json.end() && found->is_string() ? found->get<std::string>() : "";
    };
    series.Node = text("node");
    series.Message = text("message");
    if (ReadNumber(text("incarnation"), series.Incarnation) && ReadNumber(text("first_stamp"), range.First) &&
        ReadNumber(text("end_stamp"), range.End))
    {
        ledger.SetWhole(series, range);
    }
}

}  // namespace

bool ReadLedger(const std::string &folder, const std::string &node, std::uint64_t since, Ledger &ledger)
{
    const std::string marks = MarksTopicOf(node);
    RecordingIndex index(folder, node,
                         [&marks](const Mcap::Channel &channel)
                         { return channel.Topic == marks || SeriesIn(channel); });
    bool isWhole = index.Refresh(true);
    for (const auto &[name, file] : index.Files())
    {
        if (!file.IsOwn || file.NewestLog < since)
        {
            continue;
        }
        for (const RecordingIndex::Piece &piece : file.Pieces)
        {
            const auto channel = file.Channels.find(piece.Channel);
            if (piece.IsOfAnyChannel || channel == file.Channels.end())
            {
                continue;  // of a damaged part: its posts are asked for again
            }
            const auto known = SeriesIn(channel->second);
            const RecordingIndex::Access access =
                index.Visit(file, piece,
                            [&](const Mcap::Message &message)
                            {
                                if (known)
                                {
                                    ledger.Take(known->Of, StampIn(message, known->SourceToLog));
                                }
                                else
                                {
                                    TakeMark(message, ledger);
                                }
                            });
            isWhole = isWhole && access != RecordingIndex::Access::Failed;
        }
    }
    return isWhole;
}

}  // namespace Rabit::Backfill
