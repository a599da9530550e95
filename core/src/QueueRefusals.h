#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitWorkspace.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Rabit
{

// Counts and logs the messages that queues of a workspace refused because they were full, and those added
// to names that are no queues. The first refusal of each name is logged at once, later ones together, at
// most once a minute for each name. Thread-safe; logs with no lock held.
class QueueRefusals
{
public:
    static constexpr std::chrono::nanoseconds LogPeriod = std::chrono::minutes(1);
    // Programs make names at run time, so names beyond this number share one entry.
    static constexpr std::size_t MaxNames = 200;

    explicit QueueRefusals(std::shared_ptr<const RabitClock> clock) : _clock(std::move(clock)) {}

    void NoteFull(const std::string &name, int capacity);
    void NoteUnknown(const std::string &name);
    // Logs the refusals that waited for their minute to end. Cheap if nothing waits.
    void Report();
    // Sorted by name.
    std::vector<UnknownQueueInfo> Unknown() const;

private:
    struct Entry
    {
        std::uint64_t Count = 0;
        std::uint64_t NotLogged = 0;
        std::chrono::nanoseconds LoggedAt{0};
    };
    using Entries = std::map<std::string, Entry>;

    // The entry for that name. Sets `name` to the name of the shared entry if that is used.
    Entry &EntryOf(Entries &entries, std::string &name);
    // Counts one refusal, and returns how many to log now.
    std::uint64_t Count(Entry &entry);
    // Notes a refusal. firstLine() gives the text for the first of a name; line(name, count) for those
    // since the last line.
    template <typename FirstLine, typename Line>
    void Note(Entries &entries, const std::string &name, FirstLine firstLine, Line line);
    template <typename Line>
    void ReportDue(Entries &entries, Line line, std::vector<std::string> &lines);

    const std::shared_ptr<const RabitClock> _clock;
    mutable std::mutex _mutex;
    Entries _full;
    Entries _unknown;
    std::atomic<bool> _waiting{false};
};

}  // namespace Rabit
