#include "CommandLog.h"

namespace Ground
{

std::uint32_t CommandLog::Sent(const std::string &node, double nowS)
{
    ++_tallies[node].Sent;
    _commands.push_back({node, nowS});
    return ++_lastId;
}

CommandLog::Answer CommandLog::Acknowledged(std::uint32_t id, const std::string &node, bool obeyed)
{
    if (id == 0 || id > _lastId)
    {
        ++_unknown;
        return Answer::Unknown;
    }
    Entry &command = _commands[id - 1];
    if (command.Node != node)
    {
        ++_wrongNode;
        return Answer::WrongNode;
    }
    if (command.Answered)
    {
        ++_repeated;
        return Answer::Repeated;
    }
    command.Answered = true;
    Tally &tally = _tallies[node];
    ++tally.Acknowledged;
    if (!obeyed)
        ++tally.Declined;
    return Answer::Counted;
}

CommandLog::Tally CommandLog::Of(const std::string &node) const
{
    const auto found = _tallies.find(node);
    return found == _tallies.end() ? Tally{} : found->second;
}

std::vector<CommandLog::Command> CommandLog::Outstanding() const
{
    std::vector<Command> outstanding;
    for (std::size_t i = 0; i < _commands.size(); ++i)
        if (!_commands[i].Answered)
            outstanding.push_back(
                {static_cast<std::uint32_t>(i + 1), _commands[i].Node, _commands[i].SentAtS});
    return outstanding;
}

}  // namespace Ground
