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

// A hook that sees the inputs and the actions of one manager, and may replace them. With it a manager's
// steps can be recorded, and run again with the recorded inputs. RabitWorkspace::SetManagerTracing installs
// it.
//
// It sees these actions on the manager's own thread in Startup, units of work and Shutdown: readings of the
// clock of its workspace; fetches that brought something; posts; messages taken from queues of
// RabitMessages, and messages added to queues by name; lists of messages. It does not see handlers: neither
// the manager's nor those of others that run on its thread.
//
// All methods are called on the manager's thread, with no lock held. Their own actions are not traced. They
// must not throw. A trace belongs to one manager.
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

    // `isTurn`: the value of IsTurn during the step. `threw`: an exception left the step.
    virtual void BeginStep(Step step, bool isTurn) = 0;
    virtual void EndStep(bool threw) = 0;

    // A reading of a clock: the system's (RabitClock::System) or a ManualClock. The manager gets the value
    // that the trace leaves in the argument. A reading of both clocks comes as two calls, GPS time first.
    virtual void ReadMonotonic(std::chrono::nanoseconds &time) = 0;
    virtual void ReadGpsTime(double &gpsTimeSeconds) = 0;

    // The manager fetched `message`, the `number`-th post of that name.
    virtual void Fetched(const PublishSubscribeMessage &global, const RabitMessage &message,
                         std::uint64_t number) = 0;
    // Called before a post of the manager that would get the current time. Returns another time for it, or
    // nothing.
    virtual std::optional<PostTime> Posting(const PublishSubscribeMessage &global) = 0;
    // Called after each post and its handlers; the message has its time stamp.
    virtual void Posted(const PublishSubscribeMessage &global, const RabitMessage &message,
                        std::uint64_t number) = 0;

    // The manager took the message from a queue. `queue` is the queue's own name (GetMessageQueueName).
    virtual void Taken(const std::string &queue, const RabitMessage &message) = 0;
    // Called before a message is added to the queue of that name. If it returns a value, AddMessageToQueue
    // returns that value and does not add the message.
    virtual std::optional<bool> Adding(const std::string &queue, const RabitMessage &message) = 0;
    virtual void Added(bool accepted) = 0;

    // GetListOfMessages is about to return `messages`.
    virtual void Listed(std::vector<MessageInfo> &messages) = 0;

    // The trace of the manager whose step runs on this thread; null if no step runs, or it is not traced.
    static RabitManagerTrace *Current() noexcept { return _current; }

    // While a Pause lives, the actions of this thread are not traced. It gives access to the trace itself.
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
    // Read at each clock reading, so it is here to be inlined.
    static inline thread_local RabitManagerTrace *_current = nullptr;

    // Makes a trace the current one of this thread for the time of one step.
    class Scope
    {
    public:
        // The trace may be null. Otherwise it must outlive the Scope, and Begin must be called.
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

// Returns the trace for the manager of that name, which is about to start; null: no trace.
using RabitManagerTracing = std::function<std::shared_ptr<RabitManagerTrace>(const std::string &manager)>;

}  // namespace Rabit
