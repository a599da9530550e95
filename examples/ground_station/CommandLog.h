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

// Who was sent which command, and what has become of it, step by step. People know a command by its number,
// counted from 1; only the aircraft know it by its id. Times are in seconds since the ground station's
// start. Not thread-safe.
class CommandLog
{
public:
    struct Tally
    {
        std::uint64_t Sent = 0;          // accepted for sending
        std::uint64_t Acknowledged = 0;  // answered by the aircraft it was meant for
        std::uint64_t Declined = 0;      // those of the acknowledged that the aircraft would not obey
        std::uint64_t Refused = 0;       // attempts that were not accepted: nothing was sent
    };
    enum class Answer
    {
        Counted,
        Repeated,   // that command had this answer already, or its last one
        WrongNode,  // another aircraft than the one it was meant for
        Unknown     // no command of that id was sent
    };

    // Commands get the ids from `firstId` on. Choose another one in each run: then a late answer to a command
    // of an earlier run is not taken for one to a command of this run.
    explicit CommandLog(std::uint32_t firstId = 1) : _firstId(firstId) {}

    // The id for the next command. The same one until Sent or RefusedForGood is called.
    std::uint32_t NextId() const { return _firstId + static_cast<std::uint32_t>(_commands.size()); }
    // The command of NextId() was accepted for sending. Its id, number, progress and times are set here.
    std::uint32_t Sent(CommandStatus command, double nowS);
    // A command for that node was refused, and will be tried again.
    void Refused(const std::string &node) { ++_tallies[node].Refused; }
    // The command of NextId() was refused, and will not be tried again.
    void RefusedForGood(CommandStatus command, const std::string &reason, double nowS);
    // What became of the command on the way to the aircraft. Pending changes nothing.
    void OnWay(std::uint32_t id, Rabit::QueueOutcome outcome, double nowS);
    // An answer has come.
    Answer Answered(const Uav::CommandAck &answer, double nowS);

    // The id of the command of number 1.
    std::uint32_t FirstId() const { return _firstId; }
    // The aircraft has started anew since then: it obeys no command any more that it had accepted by then.
    void StartedAnew(const std::string &node, double lastHeardS, double nowS);

    // Zero for a node that was never sent anything.
    Tally Of(const std::string &node) const;
    // All of them, oldest first.
    const std::vector<CommandStatus> &Commands() const { return _commands; }
    // Commands of which nobody knows what became: neither answered by the aircraft nor certain to have never
    // arrived. Oldest first.
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
    std::uint64_t _repeated = 0;
    std::uint64_t _wrongNode = 0;
    std::uint64_t _unknown = 0;
};

}  // namespace Ground
