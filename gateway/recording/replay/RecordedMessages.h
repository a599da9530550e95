#pragma once

#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/MessageCursor.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "recording/replay/ReplayItem.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::Replay
{

// The messages of several files, in the order of their log times. A state that a recorder repeats at the
// beginning of a file is skipped if it equals the last message of its stream. Not thread-safe.
class RecordedMessages final : public ReplaySource
{
public:
    struct File
    {
        Mcap::ByteSource *Bytes = nullptr;
        const Mcap::Contents *Contents = nullptr;
    };
    // The bytes and contents of the files, and the plan, must outlive the object.
    RecordedMessages(std::vector<File> files, const ReplayPlan &plan);

    // Log times of the first and of the last message of the files, selected or not; 0 if there is none.
    Time First() const;
    Time Last() const;

    void Begin(Time from) override;
    std::optional<ReplayItem> Next() override;
    // Covers all streams but queues. Reads backwards, until it has a message of each, and no further.
    std::vector<ReplayItem> LastBefore(Time time) override;

    // The chunks that could not be read, one line each.
    std::vector<std::string> Problems() const { return {_problems.begin(), _problems.end()}; }

private:
    struct Open
    {
        std::unique_ptr<Mcap::MessageCursor> Cursor;
        std::optional<Mcap::Message> Head;
    };
    void Advance(std::size_t file);
    ReplayItem ItemOf(std::size_t file, const Mcap::Message &message) const;
    bool MayHold(std::size_t file, Time before, const std::set<std::size_t> &streams) const;
    void TakeLast(std::size_t file, Time from, Time before, const std::set<std::size_t> &streams,
                  std::vector<std::optional<ReplayItem>> &last);
    void NoteProblems(const Mcap::MessageCursor &cursor);

    const std::vector<File> _files;
    const ReplayPlan &_plan;
    std::vector<Open> _open;
    // By stream, the message that was given last.
    std::vector<std::optional<ReplayItem>> _given;
    std::set<std::string> _problems;
};

}  // namespace Rabit::Replay
