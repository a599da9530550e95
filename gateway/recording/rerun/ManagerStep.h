#pragma once

#include <rabit/RabitManagerTrace.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Rerun
{

// One thing that a manager read or did in a step.
struct StepEvent
{
    enum class Kind
    {
        Monotonic,  // a reading of the monotonic clock
        GpsTime,    // a reading of GPS time
        Fetched,    // a message that was posted
        Posted,     // a message, by the manager itself
        Taken,      // a message from a queue
        Added,      // a message to a queue, which took it
        Refused,    // or did not
        Listed      // the names of messages, as far as they were not listed before
    };

    Kind What = Kind::Monotonic;
    std::string Name{};  // of the message or the queue
    std::string Type{};  // IDL name; empty: none, then there is no sample
    // Of a post: its number among the posts of that message.
    std::uint64_t Number = 0;
    // The reading, or the time of the post; of a message in a queue only if it was ever posted.
    std::chrono::nanoseconds Monotonic{0};
    double GpsTime = 0;
    bool WasPosted = false;
    bool IsRedelivered = false;
    // Empty: the sample could not be encoded, or it is the post that was fetched before.
    std::vector<std::uint8_t> Sample{};
    std::vector<std::pair<std::string, std::string>> Names{};  // with their types
};

// One Startup, unit of work or Shutdown of a manager, and all that it read and did.
struct ManagerStep
{
    RabitManagerTrace::Step What = RabitManagerTrace::Step::UnitOfWork;
    std::uint64_t Number = 0;  // 0 is Startup
    bool IsTurn = true;
    bool Threw = false;
    std::chrono::nanoseconds Began{0};  // by the monotonic clock
    double BeganGpsTime = 0;
    std::uint64_t LogTime = 0;  // the same moment as the recording has it; not part of the text
    std::vector<StepEvent> Events{};
};

}  // namespace Rabit::Rerun
