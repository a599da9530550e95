#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace TestNode
{

// Orders of a test to a running node, by lines on standard input: `notes N` and `states N` add N notes to
// each destination, and N posts of each State. `take` and `return` end what holds up notes and a handler.
class Orders
{
public:
    // Adds up the lines that have arrived, without waiting for more. One thread. Throws std::runtime_error if
    // a line is no order.
    void Read();

    std::uint64_t Notes() const { return _notes; }
    std::uint64_t States() const { return _states; }
    bool MayTake() const { return _mayTake; }
    // Returns after the order `return`. Any thread but that of Read().
    void AwaitReturn() const { _mayReturn.wait(false); }

private:
    void Add(const std::string &line);

    std::string _rest;  // of the input, after the last whole line
    bool _ended = false;
    std::atomic<std::uint64_t> _notes = 0;
    std::atomic<std::uint64_t> _states = 0;
    bool _mayTake = false;
    std::atomic<bool> _mayReturn = false;
};

}  // namespace TestNode
