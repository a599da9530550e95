// Tools in the table. They are kept only while they are there, with only what answers and echoes need.
#include <utility>

#include "presence/PeerTable.h"

namespace Rabit
{

using Gateway::NodeState;

std::vector<std::string> PeerTable::HeardTools() const
{
    std::vector<std::string> names;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.IsTool)
        {
            names.push_back(name);
        }
    }
    return names;
}

std::uint32_t PeerTable::FleetSum() const
{
    std::uint32_t sum = _ownTag;
    for (const auto &[name, peer] : _peers)
    {
        sum += peer.IsTool || peer.State == NodeState::LOST ? 0 : peer.Tag;
    }
    return sum;
}

PeerTable::Change PeerTable::OnToolBeat(const HeardBeat &heard)
{
    Change change;
    const auto found = _peers.find(heard.Node);
    if (found != _peers.end() && !found->second.IsTool)
    {
        // The name belongs to a node, as long as that node is remembered.
        change.State = found->second.State != NodeState::LOST && NoteTwin(found->second, heard);
        return change;
    }
    Peer *tool = GetOrMakeTool(heard);
    if (tool == nullptr)
    {
        return change;
    }
    if (Duration(heard.Beat.source_ns) > tool->LastBeatSource)
    {
        Measure(*tool, heard);
        change.Beat = true;
    }
    Expect(*tool);
    return change;
}

// Null if the tool is not kept: a late beat of an earlier incarnation, or one tool too many.
PeerTable::Peer *PeerTable::GetOrMakeTool(const HeardBeat &heard)
{
    const auto found = _peers.find(heard.Node);
    if (found != _peers.end() && found->second.Incarnation == heard.Incarnation)
    {
        return &found->second;
    }
    if (found != _peers.end())
    {
        if (!IsNewLife(found->second, heard))
        {
            return nullptr;
        }
    }
    else if (_tools >= MostTools)
    {
        return nullptr;
    }
    else
    {
        ++_tools;
    }
    Peer &tool = _peers[heard.Node];
    tool.Node = heard.Node;
    tool.IsTool = true;
    tool.State = NodeState::UP;
    ++_toolsCome;
    BeginLife(tool, heard);
    return &tool;
}

std::map<std::string, PeerTable::Peer>::iterator PeerTable::ForgetTool(
    std::map<std::string, Peer>::iterator tool, Change &change)
{
    change.Forgotten.push_back(tool->first);
    --_tools;
    return _peers.erase(tool);
}

}  // namespace Rabit
