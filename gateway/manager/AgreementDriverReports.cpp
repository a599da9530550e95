// The events that the driver passes to the program, and its problems.
#include <algorithm>
#include <string>
#include <utility>

#include "manager/AgreementDriver.h"

namespace Rabit
{

void AgreementDriver::Tell(Duration now)
{
    const std::vector<OwnClaims::Event> events = _hub->TakeEvents();
    for (const OwnClaims::Event &event : events)
    {
        if (event.What == OwnClaims::Event::Kind::Lost)
        {
            _recent.Note({"claim " + event.Claim, "",
                          "lost under fence " + std::to_string(event.Fence) +
                              ": its lease has ended, since no majority of the members has answered in time; "
                              "work that began under it may still run"},
                         now);
        }
    }
    if (!events.empty())
    {
        _hub->TellClaims();
    }
    _hub->TellTable();
}

void AgreementDriver::NoteTable(Duration now)
{
    const auto [isFull, conflicts] = _hub->WithTable(
        [](TableCopy &table) { return std::pair(table.TakeRefusal(), table.TakeConflicts()); });
    if (isFull)
    {
        _recent.Note({"table", "",
                      "it has " + std::to_string(TableCopy::MostKeys) +
                          " keys, and further ones are refused: use fewer keys in the whole fleet"},
                     now);
    }
    for (const std::string &key : conflicts)
    {
        _recent.Note({"table " + key, "",
                      "nodes use this key in two ways, and a value was lost: give each key one of "
                      "Write, Add and Raise"},
                     now);
    }
}

std::size_t AgreementDriver::Answering() const
{
    const std::vector<std::string> &members = _settings.Members;
    return 1 + static_cast<std::size_t>(std::count_if(members.begin(), members.end(),
                                                      [this](const std::string &member)
                                                      { return _network.GroupOf(member) == _group; }));
}

std::vector<Gateway::Problem> AgreementDriver::Problems(const PeersOverPaths &peers, Duration now)
{
    if (_hasLeft)
    {
        return {};
    }
    NoteTable(now);
    std::vector<Gateway::Problem> problems = _recent.Problems(now);
    for (const PeerTable::Peer *const peer : peers.Heard())
    {
        if (peer->State == Gateway::NodeState::LOST)
        {
            continue;
        }
        if (!peer->Agreement && _settings.IsMember(peer->Node))
        {
            problems.push_back({"agreement " + peer->Node, peer->Node,
                                "it is one of the `members` here and has no `agreement` itself, so it does "
                                "not vote"});
        }
        else if (peer->Agreement && peer->Agreement->Group != _group)
        {
            problems.push_back({"agreement " + peer->Node, peer->Node,
                                "its `members` or its `lease` are others than those of this node: the two do "
                                "not vote for each other, and their claims do not exclude each other"});
        }
    }
    const std::size_t majority = _settings.Majority();
    const bool lacks =
        _hub->With([](const AgreementNode &node, Duration at) { return node.Own().Lacks(at); });
    if (Answering() < majority && lacks)
    {
        problems.push_back({"agreement", "",
                            std::to_string(Answering()) + " of " + std::to_string(_settings.Members.size()) +
                                " members are there with the same list, and a majority is " +
                                std::to_string(majority) + ": no claim has a new holder here"});
    }
    if (!_fenceError.empty())
    {
        problems.push_back({"agreement", "",
                            "the fences are not stored: " + _fenceError +
                                "; this node may accept no claim, and fences may fall after its next start"});
    }
    return problems;
}

std::uint64_t AgreementDriver::Malformed() const
{
    const std::uint64_t ofClaims =
        _hasLeft ? 0
                 : _hub->With([](const AgreementNode &node, Duration /*now*/) { return node.Malformed(); });
    const std::lock_guard lock(_mutex);
    return _dropped + ofClaims + _exchange.Malformed();
}

}  // namespace Rabit
