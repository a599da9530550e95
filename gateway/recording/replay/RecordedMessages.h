#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "recording/mcap/McapContents.h"
#include "recording/mcap/MessageCursor.h"
#include "recording/replay/ReplayItem.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::Replay
{

// The messages of several files on one time line, as their log times say. A state that a recorder repeats at
// the beginning of a file comes once, if it was the last of its stream. Not thread-safe.
class RecordedMessages final : public ReplaySource
{
public:
    struct File
    {
        Mcap::ByteSource *Bytes = nullptr;
        const Mcap::Contents *Contents = nullptr;
    };
    // All that is handed over must outlive it.
    RecordedMessages(std::vector<File> files, const ReplayPlan &plan);

    // Of the first and of the last message of the files, selected or not; 0 if there is none.
    Time First() const;
    Time Last() const;

    void Begin(Time from) override;
    std::optional<ReplayItem> Next() override;
    // All streams but queues. Reads no more than it must: backwards, until it has them all.
    std::vector<ReplayItem> LastBefore(Time time) override;

    // What could not be read, one line each.
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
    // By stream what was given last: when it was posted, and its bytes.
    std::vector<std::optional<ReplayItem>> _given;
    std::set<std::string> _problems;
};

}  // namespace Rabit::Replay
