#pragma once

#include <rabit/RabitClock.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{
class PublishSubscribeMessage;
class RabitMessage;
struct MessageInfo;

// Sees what one manager reads of the world around it, and what it does to it: the hook by which a manager's
// steps can be recorded, and be run again with what they read then. Given by
// RabitWorkspace::SetManagerTracing.
//
// Seen is what the manager does on its own thread in its Startup, its units of work and its Shutdown:
// readings of the clock of its workspace; fetches that brought something; posts; messages that it takes from
// queues of RabitMessages, and those that it adds to queues by name; lists of messages. Not what its handlers
// do, nor what handlers of others do on its thread.
//
// All methods are called on the manager's thread, with no lock held. What they do themselves is not seen.
// They must not throw. A trace belongs to one manager.
class RabitManagerTrace
{
public:
    enum class Step
    {
        Startup,
        UnitOfWork,
        Shutdown
    };

    virtual ~RabitManagerTrace() = default;

    // `isTurn`: what IsTurn says in it. `threw`: an exception left it.
    virtual void BeginStep(Step step, bool isTurn) = 0;
    virtual void EndStep(bool threw) = 0;

    // A reading of a clock: the system's (RabitClock::System) or a ManualClock. What is left in `time` is
    // what the manager gets. A reading of both clocks is told as two, GPS time first.
    virtual void ReadMonotonic(std::chrono::nanoseconds &time) = 0;
    virtual void ReadGpsTime(double &gpsTimeSeconds) = 0;

    // The manager has a copy of what was posted last, the `number`-th post of that message.
    virtual void Fetched(const PublishSubscribeMessage &global, const RabitMessage &message,
                         std::uint64_t number) = 0;
    // Before a post of its own that is to be stamped now: nothing, or the time that it gets.
    virtual std::optional<PostTime> Posting(const PublishSubscribeMessage &global) = 0;
    // After it, and after its handlers; the message has its time.
    virtual void Posted(const PublishSubscribeMessage &global, const RabitMessage &message,
                        std::uint64_t number) = 0;

    // From the queue that calls itself so (GetMessageQueueName). Never null.
    virtual void Taken(const std::string &queue, const RabitMessage &message) = 0;
    // Before a message is added to the queue of that name: nothing, or what AddMessageToQueue returns; then
    // it is not added.
    virtual std::optional<bool> Adding(const std::string &queue, const RabitMessage &message) = 0;
    virtual void Added(bool accepted) = 0;

    // What GetListOfMessages is about to return.
    virtual void Listed(std::vector<MessageInfo> &messages) = 0;

    // That of the manager whose step runs on this thread; null: none does, or it is not traced.
    static RabitManagerTrace *Current() noexcept { return _current; }

    // Nothing that this thread does is seen while one of these lives; it gives access to the trace itself.
    class Pause
    {
    public:
        Pause() noexcept : _trace(std::exchange(_current, nullptr)) {}
        ~Pause() { _current = _trace; }
        Pause(const Pause &) = delete;
        Pause &operator=(const Pause &) = delete;
        explicit operator bool() const { return _trace != nullptr; }
        RabitManagerTrace *operator->() const { return _trace; }

    private:
        RabitManagerTrace *const _trace;
    };

private:
    friend class RabitManager;
    // Asked for with each reading of a clock, so it is here to be inlined.
    static inline thread_local RabitManagerTrace *_current = nullptr;

    // For the time of one step.
    class Scope
    {
    public:
        // The trace, if there is one, must outlive the object, and its step begins.
        explicit Scope(RabitManagerTrace *trace) : _trace(trace), _former(std::exchange(_current, nullptr)) {}
        void Begin(Step step, bool isTurn)
        {
            _trace->BeginStep(step, isTurn);
            _current = _trace;
        }
        ~Scope()
        {
            if (_trace != nullptr)
            {
                _current = nullptr;
                _trace->EndStep(_threw);
            }
            _current = _former;
        }
        Scope(const Scope &) = delete;
        Scope &operator=(const Scope &) = delete;
        void Threw() { _threw = true; }

    private:
        RabitManagerTrace *const _trace;
        RabitManagerTrace *const _former;
        bool _threw = false;
    };
};

// Gives the trace of the manager of that name, which is about to start; null: none.
using RabitManagerTracing = std::function<std::shared_ptr<RabitManagerTrace>(const std::string &manager)>;

}  // namespace Rabit
