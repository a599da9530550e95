#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "paths/PathChoice.h"
#include "presence/PeerTable.h"

namespace Rabit
{

// The other nodes over all paths of a gateway: of each node what is known on the path that was chosen for it.
// The gateway's thread only.
class PeersOverPaths
{
public:
    // Of a gateway with one path. The table must outlive the object.
    PeersOverPaths(const PeerTable &only) : _tables{&only} {}  // NOLINT: a table is the peers over one path
    // The tables, in the order of the paths, and the choice must outlive the object.
    PeersOverPaths(std::vector<const PeerTable *> tables, const PathChoice &choice)
        : _tables(std::move(tables)), _choice(&choice)
    {
    }

    // Null: the node was not heard on any path.
    const PeerTable::Peer *Find(const std::string &node) const;
    // Nodes that have been heard, by name; no tools.
    std::vector<const PeerTable::Peer *> Heard() const;
    // Tools that are kept, by name.
    std::vector<std::string> HeardTools() const;
    // The node on that path; null if it was not heard there.
    const PeerTable::Peer *FindOn(std::size_t path, const std::string &node) const
    {
        return _tables.at(path)->Find(node);
    }

    // As PeerTable, on any path.
    bool OwnNameTwice() const;
    std::string OwnTwinPlace() const;
    std::uint64_t Forgotten() const;
    std::uint64_t CrowdedOut() const;

private:
    std::vector<const PeerTable *> _tables;
    const PathChoice *_choice = nullptr;
};

}  // namespace Rabit
