#pragma once

#include <rabit/ManagerControlMessage.h>
#include <rabit/ManagerStats.h>
#include <rabit/ManagerStatusMessage.h>
#include <rabit/RabitBoost.h>
#include <rabit/RabitLog.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitNonBlockingSPSCQueue.h>
#include <rabit/RabitStopWatch.h>
#include <rabit/RabitWakeup.h>
#include <rabit/RabitWorkspace.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace Rabit
{
class ManagerLease;
class ManagerProgress;

// A manager: a thread that runs a unit of work, sleeps, and is woken by a timer or an event. Derive from it,
// and give it to a RabitReactor.
//
// Life: Startup; then ExecuteUnitOfWork again and again until the manager is told to shut down; then
// Shutdown. All three run on the manager's own thread, never two at once. Between two units of work the
// manager sleeps for its delay (1 s unless set), unless something wakes it: a post of a chosen message, a
// message added to or taken from a queue, or a call of WakeUpManagerEH. Events that come during the unit of
// work cause one more pass instead of the sleep, however many they are. A manager that is to run once a
// second, and not also whenever it is woken, sets a period: SetPeriodSec.
//
// Exceptions of any type that leave one of the three are caught, logged, and reported in the status message
// (ManagerStatusMessage::ErrorCode_e). After a unit of work that threw, the manager sleeps as usual but at
// least 10 ms; if it otherwise would not sleep, 100 ms. A manager whose Startup threw does not run its unit
// of work: it goes on to Shutdown.
//
// Warnings, each once for a manager: a wake-up that its period keeps from waking it, and a queue of its own
// that nothing wakes it for. A third warning is for a unit of work of a second and more. They change nothing.
// Others learn of a manager that hangs or fails while it does (RabitWorkspace::GetListOfTroubledManagers).
//
// Threads: the public methods may be called from any thread unless they say otherwise. The messages and
// queues that the protected members point to are the manager's own; others attach to the same names.
// Lifetime: a started manager must be joined before it is destroyed (a reactor does it). Names that it
// registered and its wake-ups end with it.
class RabitManager
{
public:
    typedef RabitMessageQueue<std::shared_ptr<RabitMessage>> RabitQueue;
    static constexpr int DefaultQueueCapacity = 1000;

    // Registers, in the default workspace: the manager's own queue under its name, with a wake-up on what is
    // added to it; "ManagerControlMessage" and "<name>:ManagerControlMessage", with a wake-up on posts; and
    // "<name>:ManagerStatusMessage", which it posts. Throws std::invalid_argument if one of these names
    // belongs to a message of another type.
    //
    // Logs a warning if another manager has that name: the newest one gets all messages for the queue of
    // that name. The capacity of the manager's own queue is clamped as that of any queue.
    explicit RabitManager(std::string name);
    RabitManager(std::string name, int queueCapacity);
    // The same in another workspace, which must outlive the manager.
    RabitManager(std::string name, RabitWorkspace &workspace, int queueCapacity = DefaultQueueCapacity);
    virtual ~RabitManager();
    RabitManager(const RabitManager &) = delete;
    RabitManager &operator=(const RabitManager &) = delete;

    virtual void Startup() {}
    virtual void ExecuteUnitOfWork() = 0;
    virtual void Shutdown() {}

    std::string GetManagerName() { return _name; }
    RabitWorkspace &GetWorkspace() const { return _workspace; }

    std::shared_ptr<ManagerControlMessage> GetControlAllManagersMessage() { return _mgrControlAllMgrs_sptr; }
    std::shared_ptr<ManagerControlMessage> GetControlThisManagerMessage() { return _mgrControlThisMgr_sptr; }
    std::shared_ptr<ManagerStatusMessage> GetManagerStatusMessage() { return _mgrStatus_sptr; }
    std::shared_ptr<RabitQueue> GetManagerMessageQueue() { return _mgrMessageQueue_sptr; }

    // Sets whether a message added to the manager's own queue wakes it (default: true).
    void SetWakeupManagerUponMessagePostedToManagersMessageQueue(bool wakeUp);
    void SetWakeupManagerUponMessagePostedToManagersMessageQueue();

    // The longest sleep between two units of work. 0 or less: do not sleep, for a manager that blocks in its
    // unit of work. May be set at any time; a sleep that is under way follows at once. More than about 31
    // years is taken as that. NaN throws std::invalid_argument.
    void SetWakeupTimeDelayMSec(int delay_MSec);
    void SetWakeupTimeDelaySec(double delay_Sec);
    // The delay rounded to milliseconds, at most the largest int. It is 0 only if the manager does not
    // sleep.
    int GetWakeupTimeDelayMSec() const;
    double GetWakeupTimeDelaySec() const;

    // The period: the unit of work runs once in each. Wake-ups in between are seen at the next turn. A
    // sensor that posts once a second needs a period: the delay above is only the longest sleep, so each
    // wake-up causes one more pass.
    //
    // Turns lie a period apart, counted from the first unit of work, or from the moment at which a running
    // manager was given the period. They do not drift: a turn that is late because the unit of work took
    // too long does not move the others. If several turns have come meanwhile, the unit of work runs once
    // for all of them, and all but the last are counted as missed. Time for which the computer was
    // suspended has no turns. Shutdown and control messages are obeyed between turns as well.
    //
    // While there is a period, the delay is ignored. 0 or less: no period, the default. May be set at any
    // time; setting the same value again changes nothing. More than about 31 years is taken as that. NaN
    // throws std::invalid_argument.
    void SetPeriodSec(double period_Sec);
    double GetPeriodSec() const;
    // Lets events wake the manager between turns as well. Its unit of work then asks IsTurn whether to do
    // the periodic part. False, the default: registered wake-ups wait for the next turn, which is warned of
    // unless the program itself called this with false.
    void SetWakeupBetweenTurns(bool wakeUp);
    // For the unit of work: true if it runs because a turn has come, or if there is no period.
    bool IsTurn() const;
    // The missed turns since the manager was made. The status message has those since the statistics were
    // reset.
    std::uint64_t GetNumberOfMissedTurns() const;

    // Registers a message (a shared pointer to a class derived from RabitMessage) and attaches it to the
    // name's global copy. False if the name belongs to a message of another type. See RabitWorkspace.
    template <typename T>
    bool AddPublishSubscribeMessage(std::string name, T msg)
    {
        return RegisterMessage(name, std::move(msg));
    }
    // Fetching by name, see RabitWorkspace.
    bool FetchMessage(std::string name, RabitMessage *msg);
    bool ForceFetchMessage(std::string name, RabitMessage *msg);

    // The managers of all reactors of the workspace, see RabitWorkspace.
    bool DoesManagerExist(std::string managerName);
    int GetManagerIndexNumber(std::string managerName);
    int GetManagerIndexNumber();
    std::vector<std::string> GetListOfManagerNames();

    // Wakes this manager after each post of the message. Throws GlobalPublishSubscribeException if the
    // message is not registered. A second call has no effect.
    template <typename T>
    void WakeUpManagerOnMessagePost(T msg)
    {
        AddMessageWakeup(std::move(msg));
    }
    // Queues, see RabitWorkspace. T is a shared pointer to either kind of queue.
    template <typename T>
    void AddManagerMessageQueue(std::string name, T queue)
    {
        RegisterQueue(std::move(name), RabitWorkspace::MakeQueueHandle(std::move(queue)));
    }
    template <typename T>
    T GetManagerMessageQueue(std::string name)
    {
        return _workspace.template GetManagerMessageQueue<T>(std::move(name));
    }
    // Wake this manager after each message that is added to, or taken from, the queue.
    template <typename T>
    void WakeUpManagerOnEnqueue(T queue)
    {
        AddQueueWakeup(std::addressof(*queue), QueueEvent::Enqueued,
                       [&](RabitHandler handler)
                       { return queue->ConnectSomethingEnqueued(std::move(handler)); });
    }
    template <typename T>
    void WakeUpManagerOnDequeue(T queue)
    {
        AddQueueWakeup(std::addressof(*queue), QueueEvent::Dequeued,
                       [&](RabitHandler handler)
                       { return queue->ConnectSomethingDequeued(std::move(handler)); });
    }
    // See RabitWorkspace. False: no such queue, or it is full. A receipt tells the reason of a refusal at
    // once, and the outcome of the message later (RabitQueueReceipt).
    template <typename T>
    bool AddMessageToQueue(std::string name, T msg, std::shared_ptr<RabitQueueReceipt> receipt = nullptr)
    {
        return _workspace.AddMessageToQueue(std::move(name), std::move(msg), std::move(receipt));
    }
    // Wakes this manager when all messages added with the receipt have an outcome. Call it before the first
    // message is added: earlier outcomes do not wake the manager. Messages refused at the call do not wake
    // it either (RabitQueueReceipt).
    void WakeUpManagerOnOutcome(const std::shared_ptr<RabitQueueReceipt> &receipt);

    // Starts the thread and returns. Throws std::logic_error if it was started and not joined.
    void Run();
    // Waits for the thread to end. Throws std::system_error if it was not started.
    void Join();
    // Wakes this manager, which finishes its unit of work and shuts down. After a call before Run it shuts
    // down right after Startup.
    void ShutdownManager();
    // True: shuts down all managers of the workspace, and posts "ManagerControlMessage" with the flag set.
    // False: only posts that message with its flag cleared.
    void ShutdownAllManagers(bool value);
    // Logs a line with the manager's name before it: `MissionControl: text` (RabitLog). Lines below the level
    // of the log, which is Warning unless set, are dropped.
    void WriteLog(RabitLogLevel level, const std::string &text) const noexcept;
    // Wakes the manager, for the user's own handlers. The handler that WakeUpHandler returns is safe to
    // call after the manager is gone; WakeUpManagerEH is not.
    void WakeUpManagerEH();
    RabitHandler WakeUpHandler() const;

protected:
    std::shared_ptr<RabitQueue> _mgrMessageQueue_sptr;
    std::shared_ptr<ManagerControlMessage> _mgrControlAllMgrs_sptr;
    std::shared_ptr<ManagerControlMessage> _mgrControlThisMgr_sptr;
    std::shared_ptr<ManagerStatusMessage> _mgrStatus_sptr;

private:
    friend class RabitReactor;
    friend class RabitSteppedReactor;

    enum class QueueEvent
    {
        Enqueued,
        Dequeued,
        Settled
    };
    struct MessageWakeup
    {
        std::weak_ptr<RabitMessage> Message;
        RabitHandler Handler;
        std::shared_ptr<PublishSubscribeMessage> Global;
        RabitScopedConnection Connection;
    };
    struct QueueWakeup
    {
        const void *Queue;
        QueueEvent Event;
        RabitScopedConnection Connection;
    };

    void EndHandlers();
    bool RegisterMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg);
    void RegisterQueue(std::string name, std::shared_ptr<RabitQueueHandle> handle);
    void AddMessageWakeup(const std::shared_ptr<RabitMessage> &msg)
    {
        AddMessageWakeup(msg, WakeUpHandler());
    }
    void AddMessageWakeup(const std::shared_ptr<RabitMessage> &msg, const RabitHandler &handler);
    template <typename Connect>
    void AddQueueWakeup(const void *queue, QueueEvent event, Connect connect)
    {
        const std::lock_guard<std::mutex> lock(_wakeupsMutex);
        ForgetEndedQueueWakeups();
        if (!HasQueueWakeup(queue, event))
        {
            _queueWakeups.push_back(QueueWakeup{queue, event, connect(WakeUpHandler())});
            _settingsChanged.store(true);
        }
    }
    void RenewMessageWakeups();
    void ForgetEndedQueueWakeups();
    bool HasQueueWakeup(const void *queue, QueueEvent event) const;

    // The manager's run in steps. Its thread calls them one after the other; a RabitSteppedReactor calls
    // them on the thread that drives it.
    void PrepareRun();                         // registers the names again after an earlier run
    bool StartupStep();                        // false: go on with ShutdownStep
    bool CycleStep();                          // one pass; false: go on with ShutdownStep
    void SleepStep();                          // real sleep until the next pass
    void BeginSleepStep();                     // the same sleep when stepped
    std::chrono::nanoseconds NextDue() const;  // by the workspace's clock
    void EndSleepStep(std::chrono::nanoseconds now);
    std::chrono::nanoseconds PauseOfThisSleep() const;
    void CountPass(std::chrono::nanoseconds start, std::chrono::nanoseconds end);
    void ShutdownStep();
    void FinishRun();  // forgets the shutdown request, ready for another run
    void ThreadMain();

    void FetchControlMessages();
    void ObeyControlMessages();
    void TakeControlMessagesAsRead();
    std::pair<std::shared_ptr<PublishSubscribeMessage>, std::shared_ptr<PublishSubscribeMessage>>
    ControlGlobals() const;
    template <typename Work>
    bool Guard(RabitManagerTrace::Step step, std::chrono::nanoseconds now, Work work);
    void ReportFailure(RabitManagerTrace::Step step, const std::string &reason);
    void WarnOfSettings();
    void WarnOfWakeupsBetweenTurns();
    void WarnOfQueuesWithoutWakeup();
    std::string NameOfFirstWakeup();  // empty: there is none but those that every manager has
    void WarnOfLongWork(std::chrono::nanoseconds took);
    void UpdateStats(std::chrono::nanoseconds now);
    void PostStatus();
    void PostStatusIfDue(std::chrono::nanoseconds now);
    bool IsInItsLoop() const;

    const std::string _name;
    RabitWorkspace &_workspace;
    const std::shared_ptr<RabitWakeup> _wakeup;
    const std::shared_ptr<ManagerProgress> _progress;  // of the step that runs just now
    const std::unique_ptr<ManagerLease> _lease;
    std::shared_ptr<RabitManagerTrace> _trace;  // of this run; null: none

    std::mutex _wakeupsMutex;
    std::vector<MessageWakeup> _messageWakeups;
    std::vector<QueueWakeup> _queueWakeups;

    std::thread _thread;
    std::atomic<bool> _loopActive{false};
    std::atomic<std::thread::id> _loopThread{};
    // Period, wake-ups or queues, since the loop last looked at them.
    std::atomic<bool> _settingsChanged{true};
    std::atomic<bool> _delayIsChosen{false};         // by the program
    std::atomic<bool> _betweenTurnsIsChosen{false};  // by the program

    // Used by the loop alone.
    ManagerStats_t _stats;
    std::pair<bool, bool> _resetToggles{false, false};
    std::chrono::nanoseconds _statsResetAt{0};
    std::chrono::nanoseconds _statusPostedAt{0};
    std::chrono::nanoseconds _sleepBegan{0};
    std::uint64_t _missedAtReset = 0;
    bool _slept = false;
    bool _lastPassFailed = false;
    bool _startupFailed = false;
    std::chrono::nanoseconds _failureLoggedAt{0};
    int _failuresNotLogged = 0;
    bool _warnedOfPeriod = false;
    bool _warnedOfQueues = false;
    bool _warnedOfLongWork = false;
};

}  // namespace Rabit
