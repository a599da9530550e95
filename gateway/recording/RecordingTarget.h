#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clocks/SourceClock.h"
#include "recording/JsonStreams.h"
#include "recording/Recorder.h"

namespace Rabit
{

// The Recorder that gets all streams of a node, and its clock. Log time is the wall clock at the beginning
// of the recording, and from then on the monotonic clock: it never steps. Shared by all classes that
// record.
class RecordingTarget
{
public:
    RecordingTarget(std::string node, const RabitClock &clock, std::unique_ptr<RecordingDisk> disk,
                    const RecordingSettings &settings)
        : _node(std::move(node)),
          _clock(clock),
          _logClock(clock),
          _recorder(std::move(disk), settings, [this] { return Now(); })
    {
        if (settings.Record.BlackBox)
        {
            _events = Inbox().AddStream(JsonStreams::Events(_node));
        }
    }

    const std::string &Node() const { return _node; }
    RecordingInbox &Inbox() { return _recorder.Inbox(); }
    RecordingStatus Status() const { return _recorder.Status(); }

    // Return the log time now, or when the monotonic clock shows `monotonic`.
    std::uint64_t Now() const { return At(_clock.Monotonic()); }
    std::uint64_t At(std::chrono::nanoseconds monotonic) const
    {
        const std::int64_t time = _logClock.At(monotonic);
        return time < 0 ? 0 : static_cast<std::uint64_t>(time);
    }

    // Returns the offset from the monotonic clock to log time.
    std::chrono::nanoseconds MonotonicToLog() const
    {
        return std::chrono::nanoseconds(_logClock.At(std::chrono::nanoseconds(0)));
    }
    // Another part of the gateway records these messages of other nodes from now on; RecorderManager leaves
    // them out. To be called before the recorder finds them.
    void TakeOver(const std::vector<std::string> &messages)
    {
        const std::lock_guard lock(_mutex);
        _takenOver.insert(messages.begin(), messages.end());
    }
    bool IsTakenOver(const std::string &message) const
    {
        const std::lock_guard lock(_mutex);
        return _takenOver.contains(message);
    }

    // Ends the recording. Messages that are put in afterwards are dropped.
    void End() { _recorder.End(); }

    // Records a message now. `postedAt` is the log time of its post.
    bool Put(std::uint32_t stream, std::uint64_t postedAt, Mcap::Bytes data, std::uint32_t sequence = 0)
    {
        return _recorder.Inbox().Put({stream, sequence, Now(), postedAt, std::move(data)});
    }
    // Likewise, as one line of ASCII.
    void PutJson(std::uint32_t stream, const nlohmann::ordered_json &json)
    {
        const std::string text = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
        Put(stream, Now(), {text.begin(), text.end()});
    }

    // Tells of an event, for which a black box is written. Does nothing without one.
    void Happened(const std::string &what)
    {
        if (_events)
        {
            PutJson(*_events, {{"event", what}});
            Inbox().Happened(Now());
        }
    }

private:
    const std::string _node;
    const RabitClock &_clock;
    const SourceClock _logClock;
    std::optional<std::uint32_t> _events;
    mutable std::mutex _mutex;
    std::set<std::string> _takenOver;  // guarded
    Recorder _recorder;                // last: its thread uses the others
};

}  // namespace Rabit
