#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitQueueHandle.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/idl/MessageType.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace Rabit
{

// One local queue into which other nodes may put messages. Not thread-safe, but for Decode.
class AcceptedQueue
{
public:
    using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

    // A decoded payload: a message, or why there is none (WrongType, Undecodable).
    struct Decoded
    {
        LocalQueueResult Result = LocalQueueResult::WrongType;
        std::shared_ptr<RabitMessage> Message;
    };

    // `wake` is called when a message was taken from the queue after there was no room in it: on the taker's
    // thread, and possibly for a moment after this object is gone. The rule must name known types.
    AcceptedQueue(const AcceptRule &rule, RabitWorkspace &workspace, std::function<void()> wake);

    // Looks the queue up: its manager may come later than the gateway, go, and come back with a new one.
    // Returns true if the queue changed.
    bool Find();
    // Why messages cannot be delivered; empty if they can.
    std::string Problem() const;

    // True if that node may put messages into the queue. Any thread, at any time.
    bool AcceptsFrom(std::string_view node) const;
    // `type` is a LinkTypeName (names/TypeDefinition.h): another definition of a type is another type.
    bool AcceptsType(std::string_view type) const { return _types.find(type) != _types.end(); }
    // Likewise. Any thread, at any time.
    Decoded Decode(std::string_view type, std::span<const std::uint8_t> payload) const;

    // Adds a message without telling the queue's handlers: once no lock is held, call NotifyEnqueued of the
    // queue that it went into (Local). Looks the queue up if the one that was found has left the workspace.
    LocalQueueResult Deliver(const Decoded &decoded, bool redelivered);
    // Null while there is none.
    const std::shared_ptr<Queue> &Local() const { return _queue; }
    // Number of messages that the queue would take now. If it is 0, TakeRoomCame returns true once there is
    // room.
    std::size_t Room() const;
    // True, once, if there is room again after there was none, or Deliver has found another queue.
    bool TakeRoomCame();

private:
    // Shared with the queue's pop event, which may fire while this object goes.
    struct Gate
    {
        std::atomic<bool> Full{false};
        std::atomic<bool> RoomCame{false};
        std::function<void()> Wake;
    };

    std::size_t Free() const;

    AcceptRule _rule;
    RabitWorkspace &_workspace;
    // Those of the rule that are registered, by their LinkTypeNames; unchanged after construction.
    std::map<std::string, const MessageType *, std::less<>> _types;
    std::shared_ptr<Queue> _queue;
    // Of _queue. The workspace and the manager own it, so it expires once both have given the queue up.
    std::weak_ptr<RabitQueueHandle> _handle;
    bool _wrongKind = false;
    std::shared_ptr<Gate> _gate;
    RabitScopedConnection _popped;
};

}  // namespace Rabit
