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

#include "backfill/Ledger.h"
#include "recording/RecordingTarget.h"

namespace Rabit::Backfill
{

// Records the messages that are backfilled: as they come live, and what was missed at its true time. The
// sequence number of a message is the lower half of its stamp, and each series has channels of its own, so
// that ReadLedger finds in the recording what is there. Thread-safe.
class SeriesStreams
{
public:
    SeriesStreams(const GatewayConfig &config, std::shared_ptr<RecordingTarget> target,
                  std::shared_ptr<Ledger> ledger);

    // A message that came live, if it is one of those and is not recorded yet.
    void TakeLive(const GatewayTap::MirroredSample &sample);
    // A post that was missed; false if there is no room for it. `sourceToLocal` relates its time to the
    // monotonic clock here. A post whose time is not credible is dropped, and counted.
    bool TakeMissed(const Series &series, const Post &post, std::chrono::nanoseconds sourceToLocal);
    // A range that is whole from now on.
    void TakeWhole(const Series &series, Range range);

    // While paused no live message is recorded: it comes later.
    void SetPaused(bool isPaused) { _isPaused = isPaused; }

    std::uint64_t Incredible() const { return _incredible; }

    bool IsBackfilled(std::string_view message) const { return _messages.contains(message); }

private:
    std::uint32_t StreamOf(const Series &series, bool isLive, std::int64_t sourceToLog);

    const GatewayConfig _config;
    const std::shared_ptr<RecordingTarget> _target;
    const std::shared_ptr<Ledger> _ledger;
    std::set<std::string, std::less<>> _messages;
    const std::uint32_t _marks;
    std::atomic<bool> _isPaused{false};
    std::atomic<std::uint64_t> _incredible{0};
    std::mutex _mutex;
    std::map<std::pair<Series, bool>, std::uint32_t> _streams;
};

// The topic in which whole ranges are recorded, as JSON.
std::string MarksTopicOf(const std::string &node);

}  // namespace Rabit::Backfill
