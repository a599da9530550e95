#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "recording/BlackBox.h"
#include "recording/RecordingFiles.h"
#include "recording/RecordingInbox.h"

namespace Rabit
{

// A recording that a thread of its own writes, so that threads with something to record never wait for the
// disk. Thread-safe.
class Recorder
{
public:
    // Returns UTC in nanoseconds since 1970, which never goes back. Called on the recorder's thread.
    using Clock = std::function<std::uint64_t()>;
    // The first file is begun with the first message.
    Recorder(std::unique_ptr<RecordingDisk> disk, const RecordingSettings &settings, Clock clock);
    // Writes the items in the inbox, and ends the file.
    ~Recorder();

    // Does the same before destruction; from then on the inbox refuses items. To be called once, on one
    // thread.
    void End();

    RecordingInbox &Inbox() { return _inbox; }
    RecordingStatus Status() const;

private:
    void Run();
    void Write(RecordingInbox::Batch &batch);

    const Clock _clock;
    const std::unique_ptr<RecordingDisk> _disk;
    RecordingInbox _inbox;
    RecordingFiles _files;
    std::optional<BlackBox> _blackBox;
    mutable std::mutex _mutex;  // of _status
    RecordingStatus _status;
    std::thread _thread;
};

}  // namespace Rabit
