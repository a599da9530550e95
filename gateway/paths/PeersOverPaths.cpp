#include "paths/PeersOverPaths.h"

#include <algorithm>

namespace Rabit
{

const PeerTable::Peer *PeersOverPaths::Find(const std::string &node) const
{
    const PeerTable::Peer *found = _tables[_choice != nullptr ? _choice->Of(node) : 0]->Find(node);
    for (std::size_t path = 0; found == nullptr && path < _tables.size(); ++path)
    {
        found = _tables[path]->Find(node);
    }
    if (found == nullptr || found->State != Gateway::NodeState::LOST || found->Reason == PeerTable::Left)
    {
        return found;
    }
    // A goodbye that was lost on one path came by another.
    const auto hasLeft = [&node, found](const PeerTable *table)
    {
        const PeerTable::Peer *const peer = table->Find(node);
        return peer != nullptr && peer->Incarnation == found->Incarnation &&
               peer->State == Gateway::NodeState::LOST && peer->Reason == PeerTable::Left;
    };
    const auto table = std::find_if(_tables.begin(), _tables.end(), hasLeft);
    return table == _tables.end() ? found : (*table)->Find(node);
}

std::vector<const PeerTable::Peer *> PeersOverPaths::Heard() const
{
    if (_tables.size() == 1)
    {
        return _tables.front()->Heard();
    }
    std::vector<std::string> names;
    for (const PeerTable *table : _tables)
    {
        for (const PeerTable::Peer *peer : table->Heard())
        {
            names.push_back(peer->Node);
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::vector<const PeerTable::Peer *> peers;
    for (const std::string &name : names)
    {
        const PeerTable::Peer *const peer = Find(name);
        if (!peer->IsTool)
        {
            peers.push_back(peer);
        }
    }
    return peers;
}

std::vector<std::string> PeersOverPaths::HeardTools() const
{
    std::vector<std::string> names;
    for (const PeerTable *table : _tables)
    {
        const std::vector<std::string> here = table->HeardTools();
        names.insert(names.end(), here.begin(), here.end());
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

bool PeersOverPaths::OwnNameTwice() const
{
    return std::any_of(_tables.begin(), _tables.end(),
                       [](const PeerTable *table) { return table->OwnNameTwice(); });
}

std::string PeersOverPaths::OwnTwinPlace() const
{
    for (const PeerTable *table : _tables)
    {
        if (!table->OwnTwinPlace().empty())
        {
            return table->OwnTwinPlace();
        }
    }
    return {};
}

std::uint64_t PeersOverPaths::Forgotten() const
{
    std::uint64_t sum = 0;
    for (const PeerTable *table : _tables)
    {
        sum += table->Forgotten();
    }
    return sum;
}

std::uint64_t PeersOverPaths::CrowdedOut() const
{
    std::uint64_t sum = 0;
    for (const PeerTable *table : _tables)
    {
        sum += table->CrowdedOut();
    }
    return sum;
}

}  // namespace Rabit
