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

// A recording, written by a thread of its own, so that nobody who has something to record waits for the disk.
// Thread-safe.
class Recorder
{
public:
    // UTC, nanoseconds since 1970, that never goes back; called on the recorder's thread.
    using Clock = std::function<std::uint64_t()>;
    // The first file is begun with the first message.
    Recorder(std::unique_ptr<RecordingDisk> disk, const RecordingSettings &settings, Clock clock);
    // Writes what is there, and ends the file.
    ~Recorder();

    // The same while it lives: nothing is taken in any more. Once, on one thread.
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
