#pragma once

#include <functional>
#include <memory>
#include <string>

namespace Rabit
{

enum class RabitLogLevel
{
    Debug,
    Info,
    Warning,
    Error,
    Off  // only as a threshold: nothing is logged
};

// The log of the library, which prints nothing elsewhere. Warnings and errors go to stderr, one line each,
// unless the program sets another sink.
//
// stderr never blocks the thread that logs. A line is dropped if stderr does not take it at once: a full pipe
// that nobody reads, a stopped terminal, a full disk, a closed descriptor. The next line that is written says
// how many were dropped. A line longer than PIPE_BUF (4096 bytes on Linux) is cut and ends in "... (cut)".
//
// All functions may be called from any thread. None throws.
class RabitLog
{
public:
    // Gets the level and one line of text without newline. Called on the thread that logs, possibly on
    // several at once, with no lock held. If it throws, the line goes to stderr instead.
    using Sink = std::function<void(RabitLogLevel, const std::string &)>;

    // Replaces the sink; an empty one restores stderr. A call of the former sink may still be running on
    // another thread when this returns.
    static void SetSink(Sink sink);
    // Adds a listener that gets each line besides the sink, and is called like it. It ends when the
    // returned pointer is destroyed; a call may still be running then.
    [[nodiscard]] static std::shared_ptr<void> Listen(Sink listener);
    // Lines below this level are dropped. The default is Warning.
    static void SetLevel(RabitLogLevel level);
    static RabitLogLevel GetLevel();
    // The name before each line on stderr, in place of `rabit`: `uav1: warning: ...`. Several programs on one
    // terminal are told apart by it. RunNode sets it to the node's name. Sinks and listeners do not get it.
    static void SetName(const std::string &name);
    // Logs one line. Control characters (0x00 to 0x1f, 0x7f) in it become '?': text from elsewhere must not
    // begin another line, or steer a terminal.
    static void Write(RabitLogLevel level, const std::string &text) noexcept;
    // Writes a line to stderr as it is, whatever sink and level are set, for the last words of a program. It
    // never blocks either.
    static void Print(const std::string &line) noexcept;
};

}  // namespace Rabit
