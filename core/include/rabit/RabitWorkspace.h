#pragma once

#include <rabit/MessageNotRegisteredException.h>
#include <rabit/PublishSubscribeMessage.h>
#include <rabit/QueueForwarder.h>
#include <rabit/QueueTypeException.h>
#include <rabit/RabitClock.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitNonBlockingSPSCQueue.h>
#include <rabit/RabitQueueHandle.h>
#include <rabit/RabitQueueReceipt.h>

#include <boost/function.hpp>

#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Rabit
{
class QueueRefusals;
class WorkspaceForwarders;
class WorkspaceRegistry;

// The result of registering a message under a name.
enum class MessageRegistrationResult
{
    Created,   // the name is new: the message was cloned to become the global copy
    Attached,  // the name has a global copy of the same type
    OtherType  // the name has a global copy of another type; the message is unchanged
};

struct MessageRegistration
{
    MessageRegistrationResult Result;
    // The global copy of that name, also for OtherType; not null.
    std::shared_ptr<PublishSubscribeMessage> Global;
};

// Entries of the lists of registered messages and queues.
struct MessageInfo
{
    std::string Name;
    std::type_index Type;
    std::uint64_t NumberOfPosts;
};
struct QueueInfo
{
    std::string Name;
    std::type_index ElementType;
    int Capacity;
    int FillLevel;              // messages that wait in it
    std::uint64_t RefusedAdds;  // messages refused because the queue was full, since it was made
};
struct UnknownQueueInfo
{
    std::string Name;
    std::uint64_t RefusedAdds;  // messages refused because no such queue existed
};
// A manager that does not do its work now.
struct ManagerTrouble
{
    std::string Manager;
    std::string Step;  // Startup, ExecuteUnitOfWork or Shutdown
    // The step has not returned for this long; 0: it was left by an exception.
    std::chrono::nanoseconds HangsFor{0};
    std::string Failure;  // the text of that exception
};

// The names by which managers find each other's messages and queues. Most programs use the default one,
// GetWorkspace(). More can be made, for instance one for each simulated vehicle in a process. Managers of
// different workspaces share nothing.
//
// Threads: all methods may be called from any thread at any time. No lock is held while handlers, queues or
// forwarders are called. Lifetime: a workspace must outlive its managers and reactors. Messages and queues
// are shared: their holders may go on using them after the name is gone. Errors: null messages and queues
// throw std::invalid_argument.
class RabitWorkspace
{
public:
    // The default workspace; lives as long as the process.
    static RabitWorkspace *GetWorkspace();

    // Posts are stamped by this clock, and managers take time from it; without one, by RabitClock::System().
    explicit RabitWorkspace(std::shared_ptr<RabitClock> clock = nullptr);
    ~RabitWorkspace();
    RabitWorkspace(const RabitWorkspace &) = delete;
    RabitWorkspace &operator=(const RabitWorkspace &) = delete;

    RabitClock &GetClock() const { return *_clock; }

    // Forgets every message and queue name; manager names stay. A reactor forgets the names of its own
    // managers when its Run ends. It forgets all of them if no manager of another reactor is left in the
    // workspace.
    void LeavingReactor();

    // The names of the managers that were added to a reactor, in that order, each once. Index -1: no such
    // name. If a manager is destroyed before it ever ran, its name goes, unless another manager has it too.
    int GetManagerIndexNumber(std::string managerName);
    bool DoesManagerExist(std::string managerName);
    std::vector<std::string> GetListOfManagerNames();

    // Queues. Registering replaces a former queue of that name.
    template <typename T>
    void AddManagerMessageQueue(std::string name, std::shared_ptr<RabitMessageQueue<T>> queue)
    {
        AddQueue(std::move(name), MakeQueueHandle(std::move(queue)), 0);
    }
    template <typename T>
    void AddManagerMessageQueue(std::string name, std::shared_ptr<RabitNonBlockingSPSCQueue<T>> queue)
    {
        AddQueue(std::move(name), MakeQueueHandle(std::move(queue)), 0);
    }

    // T is the type of the shared pointer, such as std::shared_ptr<RabitMessageQueue<int>>. Throws
    // MessageNotRegisteredException if there is no such name, QueueTypeException (a std::bad_any_cast) if the
    // queue is of another type.
    template <typename T>
    T GetManagerMessageQueue(std::string name)
    {
        using QueueT = typename T::element_type;
        const std::shared_ptr<RabitQueueHandle> handle = FindQueueOrThrow(name);
        if (handle->QueueType() != typeid(QueueT))
        {
            throw QueueTypeException(name, handle->QueueType(), typeid(QueueT));
        }
        return std::static_pointer_cast<QueueT>(handle->Queue());
    }

    // Adds a message to the queue of that name. The message is of the queue's element type. A queue of
    // shared pointers also accepts a shared pointer to a derived class, and a queue of std::string accepts
    // values that convert to it. If there is no such queue, a message that converts to a shared pointer to
    // RabitMessage is offered to the forwarders. False if the name is unknown, the queue is full, the
    // forwarder refuses, or the message is a null pointer to a RabitMessage. Throws QueueTypeException if
    // the queue has another element type.
    //
    // Refusals by full queues and for unknown names are logged as warnings with the name: the first at
    // once, later ones together, at most once a minute. This includes messages added to a registered queue
    // directly. GetListOfQueues and GetListOfUnknownQueues return the counts.
    //
    // The receipt, if there is one, tells the outcome of the message, also a refusal and its reason; see
    // RabitQueueReceipt. If this throws, the receipt is not changed.
    template <typename T>
    bool AddMessageToQueue(std::string name, T msg, std::shared_ptr<RabitQueueReceipt> receipt = nullptr);

    // Adds a message to the local queue of that name; asks no forwarder. For adapters that receive messages
    // from elsewhere and must report why one was refused.
    QueueAddResult DeliverToQueue(const std::string &name, const std::shared_ptr<RabitMessage> &message);
    // The queue of that name as a handle; null if there is none.
    std::shared_ptr<RabitQueueHandle> FindQueue(const std::string &name) const;

    // Calls the handler after each message that is added to (taken from) the queue registered under that
    // name now, of any type (T is ignored). Returns true; throws MessageNotRegisteredException if there is
    // no such queue.
    template <typename T>
    bool Register_EnqueuedEvent(std::string name, const boost::function<void()> &handler)
    {
        FindQueueOrThrow(name)->ConnectEnqueued(handler);
        return true;
    }
    template <typename T>
    bool Register_DequeuedEvent(std::string name, const boost::function<void()> &handler)
    {
        FindQueueOrThrow(name)->ConnectDequeued(handler);
        return true;
    }
    // The same with a connection that ends it; unconnected if there is no such queue.
    RabitConnection ConnectEnqueuedEvent(const std::string &name, RabitHandler handler);
    RabitConnection ConnectDequeuedEvent(const std::string &name, RabitHandler handler);

    // Adds a forwarder, which accepts messages for names that are not queues here. QueueForwarder.h tells
    // which of several forwarders gets a message. Returns false, and adds nothing, if there is a forwarder
    // of that name.
    bool AddQueueForwarder(const std::string &forwarderName, std::shared_ptr<QueueForwarder> forwarder);
    // Removes the forwarder of that name, if there is one. Returns only when no call of it is in progress
    // any more, so the forwarder itself must not call this.
    void RemoveQueueForwarder(const std::string &forwarderName);
    // The names of the forwarders, in the order in which they were added.
    std::vector<std::string> GetListOfQueueForwarders() const;
    // For programs with one forwarder: replaces the one that was set before; null removes it. Returns when
    // RemoveQueueForwarder would. The forwarder has the name "".
    void SetQueueForwarder(std::shared_ptr<QueueForwarder> forwarder);

    // Registers the message under the name and attaches it to the name's global copy, see
    // MessageRegistration. The message is kept alive as long as the name. True if it is attached now; false
    // if the name belongs to a message of another type (also logged).
    bool AddPublishSubscribeMessage(std::string name, std::shared_ptr<RabitMessage> msg);
    // The same, with the detailed result. RabitMessageLease registers a name for a limited time.
    MessageRegistration RegisterMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg);
    // The global copy of that name; null if there is none.
    std::shared_ptr<PublishSubscribeMessage> FindGlobalMessage(const std::string &name) const;

    // GetMessage returns a clone of the global copy of that name; null if there is none. The others fetch
    // to any message of the right type: false if there is no such name, or as
    // PublishSubscribeMessage::FetchMessage.
    std::unique_ptr<RabitMessage> GetMessage(std::string name);
    bool FetchMessage(std::string name, RabitMessage *msg);
    bool ForceFetchMessage(std::string name, RabitMessage *msg);

    // Traces each manager that starts from now on with the trace that `tracing` returns for it, see
    // RabitManagerTrace. Empty: no tracing. `tracing` is called on the thread that starts the manager.
    void SetManagerTracing(RabitManagerTracing tracing);

    // The messages and queues registered now, sorted by name.
    std::vector<MessageInfo> GetListOfMessages() const;
    std::vector<QueueInfo> GetListOfQueues() const;
    // Names of missing queues to which messages were added since the workspace was made, sorted. Names
    // beyond 200 share an entry.
    std::vector<UnknownQueueInfo> GetListOfUnknownQueues() const;
    // The managers that hang or fail now, sorted by name:
    // - a unit of work that has not returned for the longer of 1 s and two periods of its manager. A manager
    //   that never sleeps does not count, since it may block there;
    // - Startup or Shutdown that have not returned for 10 s;
    // - a manager whose last unit of work threw, less than 10 s or two of its periods ago;
    // - a manager whose Startup or Shutdown threw.
    // Time is that of the workspace's clock.
    std::vector<ManagerTrouble> GetListOfTroubledManagers() const;

private:
    friend class RabitReactor;
    friend class RabitSteppedReactor;
    friend class RabitManager;
    friend class ManagerLease;
    friend class RabitMessageLease;

    void AddManagerName(const std::string &managerName, std::uint64_t owner);
    std::shared_ptr<RabitManagerTrace> TraceOf(const std::string &managerName) const;
    template <typename T>
    bool AddUntraced(const std::string &name, T &msg, const std::shared_ptr<RabitQueueReceipt> &receipt);

    // If the name is new, `global` becomes its global copy; null: a clone of the message does.
    MessageRegistration RegisterMessageFor(const std::string &name, const std::shared_ptr<RabitMessage> &msg,
                                           std::uint64_t owner,
                                           std::shared_ptr<PublishSubscribeMessage> global);
    // Owner is the number of the manager that registers, 0 if it is nobody in particular.
    void AddQueue(std::string name, std::shared_ptr<RabitQueueHandle> handle, std::uint64_t owner);
    std::shared_ptr<RabitQueueHandle> FindQueueOrThrow(const std::string &name) const;
    bool ForwardMessage(const std::string &name, const std::shared_ptr<RabitMessage> &message,
                        const std::shared_ptr<RabitQueueReceipt> &receipt);
    bool RefuseUnknown(const std::string &name, const std::shared_ptr<RabitQueueReceipt> &receipt);
    // Return true and false.
    static bool TellDelivered(const std::shared_ptr<RabitQueueReceipt> &receipt);
    static bool TellRefused(const std::shared_ptr<RabitQueueReceipt> &receipt, std::string reason);

    template <typename QueueT>
    static std::shared_ptr<RabitQueueHandle> MakeQueueHandle(std::shared_ptr<QueueT> queue)
    {
        if (!queue)
        {
            return nullptr;  // AddQueue throws
        }
        return std::make_shared<Detail::TypedQueueHandle<QueueT>>(std::move(queue));
    }

    template <typename T>
    static QueueAddResult AddToHandle(RabitQueueHandle &handle, T &msg);

    const std::shared_ptr<RabitClock> _clock;
    const std::unique_ptr<WorkspaceRegistry> _registry;
    const std::unique_ptr<WorkspaceForwarders> _forwarders;
    const std::shared_ptr<QueueRefusals> _refusals;
    mutable std::mutex _tracingMutex;
    RabitManagerTracing _tracing;
};

template <typename T>
QueueAddResult RabitWorkspace::AddToHandle(RabitQueueHandle &handle, T &msg)
{
    QueueAddResult result = handle.AddElement(typeid(T), &msg);
    if (result == QueueAddResult::WrongType)
    {
        if constexpr (std::is_convertible_v<T, std::shared_ptr<RabitMessage>>)
        {
            result = handle.AddMessage(std::shared_ptr<RabitMessage>(std::move(msg)));
        }
        else if constexpr (Detail::IsSharedPointer<T>::value)
        {
            using Pointee = typename T::element_type;
            result = handle.AddPointer(
                std::const_pointer_cast<std::remove_const_t<Pointee>>(msg),
                [](void *object) { throw static_cast<Pointee *>(object); },
                const_cast<std::remove_const_t<Pointee> *>(msg.get()));
        }
        else if constexpr (std::is_convertible_v<T, std::string>)
        {
            result = handle.AddString(std::string(std::move(msg)));
        }
    }
    return result;
}

template <typename T>
bool RabitWorkspace::AddMessageToQueue(std::string name, T msg, std::shared_ptr<RabitQueueReceipt> receipt)
{
    if constexpr (std::is_convertible_v<T, std::shared_ptr<RabitMessage>>)
    {
        if (!msg)
        {
            return TellRefused(receipt, "the message is a null pointer");
        }
        if (RabitManagerTrace::Current() != nullptr)
        {
            const RabitManagerTrace::Pause trace;
            const std::optional<bool> known = trace->Adding(name, *msg);
            const bool accepted = !known   ? AddUntraced(name, msg, receipt)
                                  : *known ? TellDelivered(receipt)
                                           : TellRefused(receipt, "it was refused in the recording");
            trace->Added(accepted);
            return accepted;
        }
    }
    return AddUntraced(name, msg, receipt);
}

template <typename T>
bool RabitWorkspace::AddUntraced(const std::string &name, T &msg,
                                 const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const std::shared_ptr<RabitQueueHandle> handle = FindQueue(name);
    if (handle)
    {
        const QueueAddResult result = AddToHandle(*handle, msg);
        if (result == QueueAddResult::WrongType)
        {
            throw QueueTypeException(name, handle->ElementType(), typeid(T));
        }
        return result == QueueAddResult::Ok
                   ? TellDelivered(receipt)
                   : TellRefused(receipt, receipt ? RefusalReasonOf(result, name) : std::string());
    }
    if constexpr (std::is_convertible_v<T, std::shared_ptr<RabitMessage>>)
    {
        return ForwardMessage(name, std::shared_ptr<RabitMessage>(std::move(msg)), receipt);
    }
    return RefuseUnknown(name, receipt);
}

}  // namespace Rabit
