#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "presence/QueueAcceptance.h"

namespace Rabit
{

// Counts the messages that were refused at the call, before they reached a link: by link, with the reason of
// the last one, or of those that the other node refused. Thread-safe.
class RefusalCounts
{
public:
    using LinkName = std::pair<std::string, std::string>;  // node, queue
    using Duration = std::chrono::nanoseconds;             // of the monotonic clock

    // A refusal is a problem for this long, unless a message is accepted earlier.
    static constexpr Duration Memory = std::chrono::minutes(1);
    // Number of links kept, as a loop may make up new names for ever. A new one replaces the one that was
    // refused longest ago.
    static constexpr std::size_t MostLinks = 1000;

    // Counts one refused message. With an empty reason it is no problem.
    void Add(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
             const std::string &reason, Duration now);
    // Tells of messages that were accepted, and refused at the other node. The links count them.
    void Tell(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
              const std::string &reason, Duration now);
    // A message was accepted: whatever was wrong is over. Costs nothing while nothing is wrong.
    void Forgive(const std::string &node, const std::string &queue);

    void Forget(const std::string &node);

    void Report(std::map<LinkName, Gateway::LinkStatus> &rows) const;
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    struct Entry
    {
        std::uint64_t Unknown = 0;
        std::uint64_t Type = 0;
        std::string Reason;         // empty: over
        bool OtherVersion = false;  // of the type: that is the reason
        Duration Last{0};           // the time of the last one
    };

    // With the mutex held. Makes the entry if there is none.
    Entry &EntryOf(const LinkName &link);
    void SetProblem(Entry &entry, QueueAcceptance acceptance, const std::string &reason, Duration now);
    void SetReason(Entry &entry, const std::string &reason);

    mutable std::mutex _mutex;
    std::map<LinkName, Entry> _entries;    // guarded by _mutex
    std::atomic<std::size_t> _reasons{0};  // entries with a reason; changed under _mutex
};

}  // namespace Rabit
