#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayTap.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "backfill/Ledger.h"
#include "backfill/Requester.h"
#include "recording/RecordingTarget.h"

namespace Rabit::Backfill
{

// Records the messages that are backfilled: as they come live, and what was missed at its true time. The
// sequence number of a message is the lower half of its stamp, and each series has channels of its own. So
// ReadLedger finds in the recording the posts that it holds. Thread-safe.
class SeriesStreams
{
public:
    // Series whose newest message is kept before the first end of the pause.
    static constexpr std::size_t MostSeriesOfFirstPause = 256;

    SeriesStreams(const GatewayConfig &config, std::shared_ptr<RecordingTarget> target,
                  std::shared_ptr<Ledger> ledger);

    // A message that came live, if it is one of those and is not recorded yet.
    void TakeLive(const GatewayTap::MirroredSample &sample);
    // A post that was missed. `sourceToLocal` relates its time to the monotonic clock here. A post whose time
    // is not credible is refused, and counted, as one that is too large; if there is no room, it is to come
    // later.
    Requester::Taken TakeMissed(const Series &series, const Post &post,
                                std::chrono::nanoseconds sourceToLocal);
    // A range that is whole from now on.
    void TakeWhole(const Series &series, Range range);

    // While paused no live message is recorded, as it comes later, but for those of SetLiveOnly. Paused from
    // the beginning on, until it is known what the recordings have. Then the newest live message of each
    // series is recorded, since its origin may not record. Not so after later pauses: the recordings may be
    // read again before that message is in them, and then it would be recorded twice.
    void SetPaused(bool isPaused);
    // Node and message of posts that do not come later: during a pause they are recorded as they come.
    void SetLiveOnly(std::set<std::pair<std::string, std::string>> series);

    std::uint64_t Incredible() const { return _incredible; }
    // Posts that do not fit into the memory of the recording.
    std::uint64_t TooLarge() const { return _tooLarge; }

    bool IsBackfilled(std::string_view message) const { return _messages.contains(message); }

private:
    // The last live message of a series before the first end of the pause.
    struct Newest
    {
        std::int64_t SourceTime = 0;
        std::chrono::nanoseconds PostedAt{0};
        Mcap::Bytes Sample;
    };

    void Record(const Series &series, std::int64_t sourceTime, std::chrono::nanoseconds posted,
                Mcap::Bytes sample);
    std::uint32_t StreamOf(const Series &series, bool isLive, std::int64_t sourceToLog);

    const GatewayConfig _config;
    const std::shared_ptr<RecordingTarget> _target;
    const std::shared_ptr<Ledger> _ledger;
    std::set<std::string, std::less<>> _messages;
    const std::uint32_t _marks;
    std::atomic<std::uint64_t> _incredible{0};
    std::atomic<std::uint64_t> _tooLarge{0};
    std::mutex _mutex;  // guards the members below
    bool _isPaused = true;
    std::map<std::pair<Series, bool>, std::uint32_t> _streams;
    bool _hasFirstPauseEnded = false;
    std::set<std::pair<std::string, std::string>> _liveOnly;
    std::map<Series, Newest> _newestOfFirstPause;
};

// The topic in which whole ranges are recorded, as JSON.
std::string MarksTopicOf(const std::string &node);

}  // namespace Rabit::Backfill
