#pragma once

#include <rabit/mcap/McapWriter.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/RecordingDisk.h"
#include "recording/RecordingInbox.h"
#include "recording/RecordingSettings.h"

namespace Rabit
{

// The state of a recording.
struct RecordingStatus
{
    std::string File;            // that is being written; empty: none
    std::string LastFile;        // that was begun last
    std::uint64_t Files = 0;     // that were begun
    std::uint64_t Messages = 0;  // that were written since the beginning, to all files
    std::uint64_t Bytes = 0;
    std::map<std::string, std::uint64_t> Lost;  // messages that were not kept, by topic
    // Those of them that had come into the memory before: the disk failed. It tells of a failure that is
    // over.
    std::uint64_t NotKept = 0;
    std::string Problem;  // why nothing is being recorded; empty: it is
};

// Writes the files of a recording: begins, splits and ends them, keeps within the free space, and counts
// messages that it could not keep. If the disk is quick enough, items are on it after half a second: a kill
// or a power loss costs no more.
//
// `now` is UTC, nanoseconds since 1970, and never goes back. Not thread-safe.
class RecordingFiles
{
public:
    using Time = std::uint64_t;

    // How long items wait in a chunk.
    static constexpr std::chrono::nanoseconds FlushPeriod = std::chrono::milliseconds(400);
    // How often free space and losses are looked at, and the pause after a failure.
    static constexpr std::chrono::nanoseconds LookPeriod = std::chrono::seconds(1);
    // States up to this size are repeated at the beginning of a file.
    static constexpr std::size_t LargestRepeated = 256U << 10;
    // So many bytes of the disk stay free, whatever the settings say.
    static constexpr std::uint64_t LeastMargin = 16U << 20;

    // The disk must outlive the object.
    RecordingFiles(RecordingDisk &disk, const RecordingSettings &settings);

    void Take(const RecordingInbox::Batch &batch, Time now);
    // Notes items that are not written: the next file begins with the last value of each state. `batch` is
    // the one that Take gets next.
    void Remember(const RecordingInbox::Batch &batch, const std::vector<RecordingItem> &items);
    // Splits, flushes and makes room when it is time. To be called every 100 ms or so.
    void Service(Time now);
    // Ends the file.
    void Close(Time now);
    // Closes the file as it is, and counts unsaved messages as lost. The next file is begun later.
    void Abandon(const std::string &problem, Time now);
    const RecordingStatus &Status() const { return _status; }
    // Returns the files that were removed since the last call, one line for the log each.
    std::vector<std::string> TakeRemovals() { return std::exchange(_removals, {}); }

private:
    struct Stream
    {
        std::shared_ptr<const RecordingStream> Info;
        std::optional<std::uint16_t> Channel;  // in the file that is being written
        std::uint64_t LostBefore = 0;          // before it came here, in all
        std::uint64_t Unsaved = 0;             // that are not on the disk yet
        std::optional<RecordingItem> Last;
    };

    void AddNewStreams(const RecordingInbox::Batch &batch);
    bool Open(Time now, Time firstLogTime);
    void RepeatStates(Time logTime);
    void KeepLast(Stream &stream, const RecordingItem &item);
    bool Write(Stream &stream, const RecordingItem &item, Time logTime);
    std::optional<std::uint16_t> ChannelOf(Stream &stream);
    void Flush(Time now);
    // Drops a file that cannot be written any more.
    void GiveUp(Time now, const std::string &problem);
    void Finish(Time now);
    void Forget();
    // MakeRoom removes old files, as far as the settings allow, until `margin` (Margin()) bytes of the disk
    // are free; false if they are not even then.
    std::uint64_t Margin() const;
    bool MakeRoom(std::uint64_t margin);
    void KeepWithinBytes();
    bool RemoveOwnStart();
    bool Remove(std::string name, const std::string &why);
    // Returns this node's files, the oldest first.
    std::vector<std::pair<std::string, std::uint64_t>> OwnFiles();
    void WriteLosses();
    void Lose(Stream &stream, std::uint64_t count);

    RecordingDisk &_disk;
    const RecordingSettings _settings;
    std::vector<Stream> _streams;
    std::map<std::string, Mcap::TextMap> _metadata;
    std::map<std::pair<std::string, std::string>, std::uint16_t> _schemas;  // of the file: name and text
    std::unique_ptr<RecordingDisk::File> _file;
    std::unique_ptr<Mcap::McapWriter> _writer;
    std::optional<std::uint64_t> _number;  // of the next file
    std::deque<std::string> _begun;        // files of this recording that were not removed, the oldest first
    std::vector<std::string> _removals;
    std::string _recording;  // the first file's name, in all of them: they belong together
    Time _openedAt = 0;
    Time _flushedAt = 0;
    Time _nextLook = 0;
    Time _notBefore = 0;
    std::uint64_t _bytesBefore = 0;  // of files that are ended
    bool _lossesChanged = false;
    RecordingStatus _status;
};

}  // namespace Rabit
