#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "presence/RemoteQueues.h"

namespace Rabit
{

// Messages that were refused at the call, before they reached a link: counted by link, and why the last one
// was. Not thread-safe.
class LinkRefusals
{
public:
    using LinkName = std::pair<std::string, std::string>;  // node, queue

    void Add(const LinkName &link, QueueAcceptance verdict, const std::string &reason);
    // A message was accepted: whatever was wrong is over.
    void Forgive(const LinkName &link);

    void Report(std::map<LinkName, Gateway::LinkStatus> &rows) const;
    std::vector<Gateway::Problem> Problems() const;

private:
    struct Entry
    {
        std::uint64_t Unknown = 0;
        std::uint64_t Type = 0;
        std::string Reason;
    };
    std::map<LinkName, Entry> _entries;
};

}  // namespace Rabit
