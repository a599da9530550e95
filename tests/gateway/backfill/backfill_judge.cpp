// backfill_judge FOLDER_OF_ORIGIN ORIGIN FOLDER GROUND MESSAGE...: compares the posts of each message in the
// recording of their origin node with those in the recording of another node. Prints one JSON object a
// message.
#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "backfill/FolderPosts.h"
#include "backfill/RecordedSeries.h"
#include "backfill/RecordingIndex.h"

namespace
{

using namespace Rabit;
using namespace Rabit::Backfill;

struct Recorded
{
    std::vector<std::uint8_t> Bytes;
    std::uint64_t PublishTime = 0;
    int Times = 0;
    int Missed = 0;  // times that it came later
    std::string Where;
};
using Posts = std::map<std::pair<std::uint64_t, Stamp>, Recorded>;

Posts PostsOf(RecordingIndex &index, const std::string &topic)
{
    Posts posts;
    index.Refresh(true);
    for (const auto &[name, file] : index.Files())
    {
        std::map<std::uint16_t, bool> isFirst;
        std::uint64_t incarnation = 0;
        std::int64_t sourceToLog = 0;
        if (const auto clock = file.Metadata.find("rabit.clock"); clock != file.Metadata.end())
        {
            ReadNumber(Mcap::ValueOf(clock->second, "incarnation"), incarnation);
            ReadNumber(Mcap::ValueOf(clock->second, "source_to_log_ns"), sourceToLog);
        }
        for (const RecordingIndex::Piece &piece : file.Pieces)
        {
            const auto known = file.Channels.find(piece.Channel);
            if (known == file.Channels.end() || known->second.Topic != topic)
            {
                continue;
            }
            const Mcap::Channel &channel = known->second;
            const auto series = SeriesIn(channel);
            index.Visit(
                file, piece,
                [&](const Mcap::Message &message)
                {
                    const std::pair key(
                        series ? series->Of.Incarnation : incarnation,
                        series ? StampIn(message, series->SourceToLog)
                               : StampOf(static_cast<std::int64_t>(message.PublishTime) - sourceToLog));
                    Recorded &post = posts[key];
                    // The last message of a state is repeated at the beginning of a file.
                    const bool isRepeated = isFirst.try_emplace(channel.Id, true).second && post.Times > 0;
                    post.Times += isRepeated ? 0 : 1;
                    post.Missed += Mcap::Describe(channel).Kind == Mcap::ChannelKind::Backfilled ? 1 : 0;
                    post.Bytes.assign(message.Data.begin(), message.Data.end());
                    post.PublishTime = message.PublishTime;
                });
        }
    }
    return posts;
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc < 6)
    {
        return 2;
    }
    const std::string origin = argv[2];
    for (int i = 5; i < argc; ++i)
    {
        const std::string topic = origin + "/" + argv[i];
        const auto wants = [&topic](const Mcap::Channel &channel) { return channel.Topic == topic; };
        RecordingIndex there(argv[1], origin, wants);
        RecordingIndex here(argv[3], argv[4], wants);
        const Posts posted = PostsOf(there, topic);
        Posts recorded = PostsOf(here, topic);
        int missing = 0;
        int twice = 0;
        int other = 0;
        int missed = 0;
        // The number of the first post that is missing, in their order; the number of all if none is.
        std::size_t oldestMissing = posted.size();
        std::size_t number = 0;
        std::int64_t worst = 0;
        for (const auto &[key, post] : posted)
        {
            const auto found = recorded.find(key);
            ++number;
            if (found == recorded.end())
            {
                ++missing;
                oldestMissing = std::min(oldestMissing, number - 1);
                continue;
            }
            if (found->second.Times > 1)
            {
                ++twice;
                std::fprintf(stderr, "twice: %s\n", found->second.Where.c_str());
            }
            other += found->second.Bytes == post.Bytes ? 0 : 1;
            missed += found->second.Missed;
            worst = std::max(worst, std::abs(static_cast<std::int64_t>(found->second.PublishTime) -
                                             static_cast<std::int64_t>(post.PublishTime)));
            recorded.erase(found);
        }
        // Posts that the origin lost when it was killed.
        std::printf(R"({"message": "%s", "posted": %zu, "missing": %d, "twice": %d, "other_bytes": %d, )"
                    R"("backfilled": %d, "only_here": %zu, "oldest_missing": %zu, "worst_time_ms": %.3f})"
                    "\n",
                    argv[i], posted.size(), missing, twice, other, missed, recorded.size(), oldestMissing,
                    static_cast<double>(worst) / 1e6);
    }
    return 0;
}
