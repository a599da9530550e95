#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace Ground
{

// Who was sent which command, and who has answered. Not thread-safe.
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
    struct Command
    {
        std::uint32_t Id = 0;
        std::string Node;
        double SentAtS = 0;
    };
    enum class Answer
    {
        Counted,
        Repeated,   // that command had its answer already
        WrongNode,  // another aircraft than the one it was meant for
        Unknown     // no command of that number was sent
    };

    // The number for the next command, from 1. The same one until Sent is called.
    std::uint32_t NextId() const { return _lastId + 1; }
    // The command of NextId() was accepted for sending. Returns its number.
    std::uint32_t Sent(const std::string &node, double nowS);
    // A command for that node was refused.
    void Refused(const std::string &node) { ++_tallies[node].Refused; }
    // An answer has come.
    Answer Acknowledged(std::uint32_t id, const std::string &node, bool obeyed);

    // Zero for a node that was never sent anything.
    Tally Of(const std::string &node) const;
    // Commands that wait for their answer, oldest first.
    std::vector<Command> Outstanding() const;
    // Answers that were not Counted.
    std::uint64_t Repeated() const { return _repeated; }
    std::uint64_t WrongNode() const { return _wrongNode; }
    std::uint64_t Unknown() const { return _unknown; }

private:
    struct Entry
    {
        std::string Node;
        double SentAtS = 0;
        bool Answered = false;
    };

    std::uint32_t _lastId = 0;
    std::vector<Entry> _commands;  // command number i + 1 is element i
    std::map<std::string, Tally> _tallies;
    std::uint64_t _repeated = 0;
    std::uint64_t _wrongNode = 0;
    std::uint64_t _unknown = 0;
};

}  // namespace Ground
