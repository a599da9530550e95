#pragma once

#include <rabit/RabitEvent.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace Rabit
{

// Calls the handlers of events in place of threads that must not block, such as those that receive from a
// network. A handler that takes seconds delays only the other handlers that are called here.
//
// A thread that must not block makes a Scope and fires events in it. RabitQuickHandlers are called at once,
// on the firing thread; all other handlers are called here, in the order in which they were handed over. A
// handler that already waits is not handed over again: one call then stands for several events, and begins
// after the last of them. So at most one call per handler waits.
//
// Threads: any thread may make a Scope; Stop and the destructor may be called by one thread at a time, and
// not by a handler. The thread is started with the first handler; if the system has no more threads, handlers
// are called on the thread that fires. No lock is held while a handler or the watch is called.
class RabitHandlerThread
{
public:
    // Is told when a handler begins and returns, on the thread that calls it. Must not throw.
    class Watch
    {
    public:
        virtual ~Watch() = default;
        virtual void Begins(const std::string &subject) = 0;
        virtual void Returned() = 0;
    };

    // The watch, if there is one, must outlive the object.
    explicit RabitHandlerThread(Watch *watch = nullptr) : _watch(watch) {}
    // As Stop.
    ~RabitHandlerThread();
    RabitHandlerThread(const RabitHandlerThread &) = delete;
    RabitHandlerThread &operator=(const RabitHandlerThread &) = delete;

    // Waits until the handlers that were handed over have returned, and ends the thread. From then on
    // handlers are called on the thread that fires.
    void Stop();

    // While a Scope lives, events fired on this thread are handled as described above. `subject` describes
    // them for people, such as `uav1/Pose`. `owner` contains the events and is kept alive until their
    // handlers have returned. Both must outlive the Scope. If `thread` is null, the Scope does nothing.
    class Scope
    {
    public:
        template <typename Owner>
        Scope(RabitHandlerThread *thread, const std::string &subject, const std::shared_ptr<Owner> &owner)
            : _thread(thread),
              _subject(subject),
              _owner(&owner),
              _shareOwner([](const void *shared) -> std::shared_ptr<const void>
                          { return *static_cast<const std::shared_ptr<Owner> *>(shared); }),
              _outer(_current)
        {
            _current = _thread != nullptr ? this : _outer;
        }
        template <typename Owner>
        Scope(RabitHandlerThread *thread, const std::string &subject,
              std::shared_ptr<Owner> &&owner) = delete;
        ~Scope() { _current = _outer; }
        Scope(const Scope &) = delete;
        Scope &operator=(const Scope &) = delete;

        // The innermost Scope of this thread; null if there is none.
        static Scope *Current() { return _current; }
        // Returns false if the caller must call the handler itself, now.
        bool HandOver(const std::shared_ptr<Detail::EventSlot> &handler) const;

    private:
        static inline thread_local Scope *_current = nullptr;

        RabitHandlerThread *const _thread;
        const std::string &_subject;
        // The owner's shared pointer, and the function that copies it. It is copied only when a handler is
        // handed over, which few scopes do.
        const void *const _owner;
        std::shared_ptr<const void> (*const _shareOwner)(const void *shared);
        Scope *const _outer;
    };

private:
    struct Waiting
    {
        std::shared_ptr<Detail::EventSlot> Handler;
        std::string Subject;
        std::shared_ptr<const void> Owner;
    };

    bool Add(const std::shared_ptr<Detail::EventSlot> &handler, const std::string &subject,
             std::shared_ptr<const void> owner);
    bool IsStarted();
    void Run();
    void Call(const Waiting &waiting);

    Watch *const _watch;
    std::mutex _mutex;
    std::condition_variable _changed;
    std::deque<Waiting> _waiting;  // guarded, as what follows
    bool _stopped = false;
    std::thread _thread;
};

}  // namespace Rabit
