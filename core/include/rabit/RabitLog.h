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

// The one place through which the library says something. Warnings and errors go to stderr, one line each,
// unless the program sets another sink; nothing else is printed.
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
    // Has each line told to somebody besides the sink, who is called as it is, for as long as what this
    // returns is kept. A call may still be running when that is dropped.
    [[nodiscard]] static std::shared_ptr<void> Listen(Sink listener);
    // Lines below this level are dropped. The default is Warning.
    static void SetLevel(RabitLogLevel level);
    static RabitLogLevel GetLevel();
    static void Write(RabitLogLevel level, const std::string &text) noexcept;
};

}  // namespace Rabit
