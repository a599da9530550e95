#include "CommandLog.h"

#include <utility>

namespace Ground
{
namespace
{
// Orders the progress of a command: later steps have higher numbers, and final ones the highest.
int Rank(CommandProgress progress)
{
    switch (progress)
    {
        case CommandProgress::PROGRESS_SENT:
            return 0;
        case CommandProgress::PROGRESS_DELIVERED:
        case CommandProgress::PROGRESS_IN_DOUBT:
            return 1;
        case CommandProgress::PROGRESS_ACCEPTED:
            return 2;
        case CommandProgress::PROGRESS_DONE:
        case CommandProgress::PROGRESS_DECLINED:
        case CommandProgress::PROGRESS_REPLACED:
        case CommandProgress::PROGRESS_EXPIRED:
        case CommandProgress::PROGRESS_REFUSED:
            return 3;
    }
    return 3;
}

CommandProgress ProgressOf(Uav::CommandStage stage)
{
    switch (stage)
    {
        case Uav::CommandStage::COMMAND_ACCEPTED:
            return CommandProgress::PROGRESS_ACCEPTED;
        case Uav::CommandStage::COMMAND_DECLINED:
            return CommandProgress::PROGRESS_DECLINED;
        case Uav::CommandStage::COMMAND_DONE:
            return CommandProgress::PROGRESS_DONE;
        case Uav::CommandStage::COMMAND_REPLACED:
            return CommandProgress::PROGRESS_REPLACED;
    }
    return CommandProgress::PROGRESS_DECLINED;
}

CommandProgress ProgressOf(Rabit::QueueOutcome outcome)
{
    switch (outcome)
    {
        case Rabit::QueueOutcome::Pending:
            return CommandProgress::PROGRESS_SENT;
        case Rabit::QueueOutcome::Delivered:
            return CommandProgress::PROGRESS_DELIVERED;
        case Rabit::QueueOutcome::Expired:
            return CommandProgress::PROGRESS_EXPIRED;
        case Rabit::QueueOutcome::InDoubt:
            return CommandProgress::PROGRESS_IN_DOUBT;
        case Rabit::QueueOutcome::Refused:
            return CommandProgress::PROGRESS_REFUSED;
    }
    return CommandProgress::PROGRESS_REFUSED;
}

void Step(CommandStatus &command, CommandProgress progress, const std::string &reason, double nowS)
{
    command.progress = progress;
    command.reason = reason;
    command.changed_s = nowS;
    CommandStep step;
    step.progress = progress;
    step.reason = reason;
    step.at_s = nowS;
    command.steps.push_back(step);
}

// Sets the progress, unless the command has reached it or a later one. Returns whether it was set.
bool Advance(CommandStatus &command, CommandProgress progress, const std::string &reason, double nowS)
{
    if (Rank(progress) <= Rank(command.progress))
        return false;
    Step(command, progress, reason, nowS);
    return true;
}
}  // namespace

std::uint32_t CommandLog::Sent(CommandStatus command, double nowS)
{
    ++_tallies[command.node].Sent;
    return Append(std::move(command), CommandProgress::PROGRESS_SENT, "", nowS).id;
}

void CommandLog::RefusedForGood(CommandStatus command, const std::string &reason, double nowS)
{
    ++_tallies[command.node].Refused;
    Append(std::move(command), CommandProgress::PROGRESS_REFUSED, reason, nowS);
}

CommandStatus &CommandLog::Append(CommandStatus command, CommandProgress progress, const std::string &reason,
                                  double nowS)
{
    command.id = NextId();
    command.number = static_cast<std::uint32_t>(_commands.size() + 1);
    command.sent_s = nowS;
    Step(command, progress, reason, nowS);
    _commands.push_back(std::move(command));
    return _commands.back();
}

CommandStatus *CommandLog::Find(std::uint32_t id)
{
    const std::uint32_t index = id - _firstId;  // wraps around as the ids do
    return index < _commands.size() ? &_commands[index] : nullptr;
}

void CommandLog::OnWay(std::uint32_t id, Rabit::QueueOutcome outcome, double nowS)
{
    const char *reason = outcome == Rabit::QueueOutcome::Refused ? "the aircraft does not take it" : "";
    if (CommandStatus *command = Find(id))
        Advance(*command, ProgressOf(outcome), reason, nowS);
}

CommandLog::Answer CommandLog::Answered(const Uav::CommandAck &answer, double nowS)
{
    CommandStatus *command = Find(answer.id);
    if (command == nullptr || command->progress == CommandProgress::PROGRESS_REFUSED)
    {
        ++_unknown;
        return Answer::Unknown;
    }
    if (command->node != answer.node)
    {
        ++_wrongNode;
        return Answer::WrongNode;
    }
    const bool first = Rank(command->progress) < Rank(CommandProgress::PROGRESS_ACCEPTED);
    // An answer proves the delivery, even if the receipt comes later.
    if (command->progress == CommandProgress::PROGRESS_SENT)
        Advance(*command, CommandProgress::PROGRESS_DELIVERED, "", nowS);
    if (!Advance(*command, ProgressOf(answer.stage), ReasonOf(answer), nowS))
    {
        ++_repeated;
        return Answer::Repeated;
    }
    if (first)
    {
        Tally &tally = _tallies[answer.node];
        ++tally.Acknowledged;
        if (answer.stage == Uav::CommandStage::COMMAND_DECLINED)
            ++tally.Declined;
    }
    return Answer::Counted;
}

void CommandLog::StartedAnew(const std::string &node, double lastHeardS, double nowS)
{
    _startedAnewS[node] = nowS;
    for (CommandStatus &command : _commands)
        if (command.node == node && command.progress == CommandProgress::PROGRESS_ACCEPTED &&
            command.changed_s <= lastHeardS)
            Advance(command, CommandProgress::PROGRESS_REPLACED, "the aircraft has started anew", nowS);
}

// A command is also in doubt if it expired while its aircraft was silent. An aircraft that has not restarted
// may decline it then, and its answer may come later than its state.
void CommandLog::Reported(const std::string &node, std::uint32_t lastCommand, double postedS, double nowS)
{
    const auto startedAnew = _startedAnewS.find(node);
    for (CommandStatus &command : _commands)
    {
        if (command.node != node || command.progress != CommandProgress::PROGRESS_IN_DOUBT ||
            postedS <= command.changed_s)
            continue;
        if (command.id == lastCommand)
        {
            Advance(command, CommandProgress::PROGRESS_ACCEPTED, "", nowS);
            ++_tallies[node].Acknowledged;
        }
        else if (startedAnew != _startedAnewS.end() && command.sent_s < startedAnew->second)
            Advance(command, CommandProgress::PROGRESS_REPLACED, "the aircraft has started anew", nowS);
    }
}

// The reason of the answer, with ids of commands replaced by their numbers.
std::string CommandLog::ReasonOf(const Uav::CommandAck &answer) const
{
    if (answer.replaced_by == 0)
        return answer.reason;
    const std::uint32_t index = answer.replaced_by - _firstId;
    if (index >= _commands.size())
        return "a command that this ground station did not give";
    return "command " + std::to_string(_commands[index].number);
}

CommandLog::Tally CommandLog::Of(const std::string &node) const
{
    const auto found = _tallies.find(node);
    return found == _tallies.end() ? Tally{} : found->second;
}

std::vector<CommandStatus> CommandLog::Outstanding() const
{
    std::vector<CommandStatus> outstanding;
    for (const CommandStatus &command : _commands)
        if (Rank(command.progress) < Rank(CommandProgress::PROGRESS_ACCEPTED))
            outstanding.push_back(command);
    return outstanding;
}

}  // namespace Ground
