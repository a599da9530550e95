#pragma once

#include <atomic>
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
// the last one. Thread-safe.
class RefusalCounts
{
public:
    using LinkName = std::pair<std::string, std::string>;  // node, queue

    // Counts one refused message.
    void Add(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
             const std::string &reason);
    // A message was accepted: whatever was wrong is over. Costs nothing while nothing is wrong.
    void Forgive(const std::string &node, const std::string &queue);

    void Forget(const std::string &node);

    void Report(std::map<LinkName, Gateway::LinkStatus> &rows) const;
    std::vector<Gateway::Problem> Problems() const;

private:
    struct Entry
    {
        std::uint64_t Unknown = 0;
        std::uint64_t Type = 0;
        std::string Reason;         // empty: over
        bool OtherVersion = false;  // of the type: that is the reason
    };

    void SetReason(Entry &entry, const std::string &reason);

    mutable std::mutex _mutex;
    std::map<LinkName, Entry> _entries;    // guarded by _mutex
    std::atomic<std::size_t> _reasons{0};  // entries with a reason; changed under _mutex
};

}  // namespace Rabit
