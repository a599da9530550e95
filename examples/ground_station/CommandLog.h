#pragma once

#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/RabitQueueReceipt.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace Ground
{

// Records each command sent to an aircraft, and its progress step by step. People know a command by its
// number, counted from 1; the aircraft know it by its id. Times are in seconds since the ground station's
// start. Not thread-safe.
class CommandLog
{
public:
    struct Tally
    {
        std::uint64_t Sent = 0;          // accepted for sending
        std::uint64_t Acknowledged = 0;  // answered by the aircraft it was meant for
        std::uint64_t Declined = 0;      // acknowledged ones that the aircraft declined
        std::uint64_t Refused = 0;       // attempts that were not accepted: nothing was sent
    };
    enum class Answer
    {
        Counted,
        Repeated,   // that command already had this answer, or a final one
        WrongNode,  // the answer is from an aircraft that the command was not sent to
        Unknown     // no command of that id was sent
    };

    // Commands get the ids from `firstId` on. Choose a different one in each run, so that late answers to
    // an earlier run are not taken for answers to this run.
    explicit CommandLog(std::uint32_t firstId = 1) : _firstId(firstId) {}

    // The id for the next command. The same one until Sent or RefusedForGood is called.
    std::uint32_t NextId() const { return _firstId + static_cast<std::uint32_t>(_commands.size()); }
    // The command of NextId() was accepted for sending. Its id, number, progress and times are set here.
    std::uint32_t Sent(CommandStatus command, double nowS);
    // A command for that node was refused, and will be tried again.
    void Refused(const std::string &node) { ++_tallies[node].Refused; }
    // The command of NextId() was refused, and will not be tried again.
    void RefusedForGood(CommandStatus command, const std::string &reason, double nowS);
    // Notes the outcome of delivering the command to the aircraft. Pending changes nothing.
    void OnWay(std::uint32_t id, Rabit::QueueOutcome outcome, double nowS);
    // Notes an answer of an aircraft.
    Answer Answered(const Uav::CommandAck &answer, double nowS);

    // Notes a MissionState that the aircraft posted at `postedS`, with the id of the last command that it
    // obeyed. That ends the doubt about a command that the aircraft obeys, or without which it has started
    // anew (StartedAnew).
    void Reported(const std::string &node, std::uint32_t lastCommand, double postedS, double nowS);

    // The id of the command of number 1.
    std::uint32_t FirstId() const { return _firstId; }
    // The aircraft has restarted since it was last heard: it has forgotten the commands that it had
    // accepted by then.
    void StartedAnew(const std::string &node, double lastHeardS, double nowS);

    // Zero for a node that never got a command.
    Tally Of(const std::string &node) const;
    // All of them, oldest first.
    const std::vector<CommandStatus> &Commands() const { return _commands; }
    // Commands with an unknown outcome: neither answered by the aircraft, nor certainly not arrived. Oldest
    // first.
    std::vector<CommandStatus> Outstanding() const;
    // Answers that were not Counted.
    std::uint64_t Repeated() const { return _repeated; }
    std::uint64_t WrongNode() const { return _wrongNode; }
    std::uint64_t Unknown() const { return _unknown; }

private:
    CommandStatus &Append(CommandStatus command, CommandProgress progress, const std::string &reason,
                          double nowS);
    CommandStatus *Find(std::uint32_t id);
    std::string ReasonOf(const Uav::CommandAck &answer) const;

    std::uint32_t _firstId;
    std::vector<CommandStatus> _commands;
    std::map<std::string, Tally> _tallies;
    std::map<std::string, double> _startedAnewS;  // by node: when it was last told
    std::uint64_t _repeated = 0;
    std::uint64_t _wrongNode = 0;
    std::uint64_t _unknown = 0;
};

}  // namespace Ground
